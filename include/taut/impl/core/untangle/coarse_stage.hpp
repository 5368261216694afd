// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/core/hierarchy/make_hierarchy.hpp>
#include <taut/impl/core/start/raise_map.hpp>
#include <taut/impl/core/untangle/element_newton.hpp>
#include <taut/impl/core/untangle/harmonic_stage.hpp>
#include <taut/impl/core/untangle/margin.hpp>
#include <taut/impl/core/untangle/newton_stage.hpp>
#include <taut/impl/core/untangle/pull_stage.hpp>
#include <taut/impl/core/untangle/run_stages.hpp>
#include <taut/untangle.hpp>

namespace taut::impl
{

/// Untangles a coarse level of the mesh, where steps take milliseconds, and reinserts the remaining vertices into its
/// map, which flips nothing. Fixed vertices are on all levels. Where a level cannot be untangled, or is infeasible,
/// which the mesh itself need not be, the next finer one is, as long as that is small.
class coarse_stage final : public untangle_stage<triangle>
{
public:
    std::string_view name() const override { return "coarse"; }

    bool run(untangle_state<triangle>& state, int) override;

private:
    static constexpr std::size_t fewest = 1000, most = 6000; // vertices of a coarse level
    static constexpr std::size_t few = 20;                   // defects: reinsertion may get rid of them

    static hierarchy<triangle> levels_of(const untangle_problem<triangle>& problem, std::function<bool()> proceed)
    {
        std::vector<char> keep(problem.held.size());
        for (std::size_t v = 0; v < keep.size(); ++v) keep[v] = problem.held.any(v);
        return make_hierarchy(problem.rest, keep, {.factor = 4, .proceed = std::move(proceed)});
    }

    /// Stages for a level: where a boundary is free, those that create no branch points.
    static untangle_stages<triangle> stages(bool outline_pinned);

    /// Computes a map of a level with few defects; empty if there is none.
    std::optional<std::vector<vec2>> untangled(untangle_state<triangle>& state, const hierarchy<triangle>& h,
                                               std::size_t l, int steps)
    {
        const auto& problem = state.problem();
        const auto& chosen = h.levels[l].vertices;
        untangle_problem<triangle> part{level_mesh(h, l, problem.rest.points()), {}, fixed_marks<2>(chosen.size()), {}};
        for (std::size_t i = 0; i < chosen.size(); ++i)
        {
            const auto v = static_cast<std::size_t>(chosen[i]);
            part.initial.push_back(problem.initial[v]);
            if (!problem.draft.empty()) part.draft.push_back(problem.draft[v]);
            part.held[i] = problem.held[v];
        }
        const run_limits limits{.time_limit = std::chrono::duration<double>(state.seconds_left()),
                                .observer = [&state](const progress& p) { return state.proceed(p); }};
        untangle_params how;
        how.tuning.first_round = steps;
        how.rounds = 1;
        untangle_state<triangle> coarse(part, limits, newton_maker<triangle>(impl::direct_newton));
        if (!coarse.injective() && !find_infeasibility(part))
        {
            coarse.ended("proofs", "");
            impl::run_stages(coarse, stages(part.outline_pinned()), how);
        }
        else
            coarse.ended("proofs", coarse.injective() ? "" : "infeasible");
        if (coarse.injective())
        {
            impl::improve_margin(coarse, how.tuning.margin_steps);
            coarse.ended("margin", "");
        }
        state.append(coarse.stages(), l);
        if (coarse.flips().defects() > few) return std::nullopt;
        return coarse.best_map();
    }

    /// Prolongs a map of a level to the finest one.
    void raise(untangle_state<triangle>& state, const hierarchy<triangle>& h, std::size_t l, std::vector<vec2> uv)
    {
        const auto& problem = state.problem();
        std::vector<char> fixed(problem.held.size());
        for (std::size_t v = 0; v < fixed.size(); ++v) fixed[v] = problem.held.any(v);
        // In the size of the map, so that stars are not drawn to another one.
        double rest = 0;
        for (idx c = 0; c < problem.rest.cell_count(); ++c)
        {
            const auto x = problem.rest.rest(c);
            rest += 0.5 * glm::length(glm::cross(x[1] - x[0], x[2] - x[0]));
        }
        const double size = std::sqrt(impl::expected_measure(problem, problem.initial) / rest);
        auto points = problem.rest.points();
        for (vec3& p : points) p *= size;
        while (l-- > 0)
        {
            auto finer = impl::raise_map(h, l, points, std::move(uv), {.fixed = fixed});
            state.now().level = l;
            state.now().energy_before = finer.energy.before;
            state.now().energy_after = finer.energy.after;
            state.ended("reinsert", "");
            if (!state.proceed(0)) return;
            uv = std::move(finer.uv);
        }
        state.take(uv);
    }
};

} // namespace taut::impl
