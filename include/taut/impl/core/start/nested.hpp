// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/measure/describe_defects.hpp>
#include <taut/impl/core/mesh/describe.hpp>
#include <taut/impl/core/objective/stage_report.hpp>
#include <taut/impl/core/start/level_solver.hpp>
#include <taut/impl/core/start/robust.hpp>
#include <taut/options.hpp>
#include <taut/start_map.hpp>

namespace taut::impl
{

/// Parameters of the levels above the finest one, which are solved roughly, as the next one changes everything a
/// little. Before each one `start.proceed` is asked, too.
struct nested_params
{
    std::size_t start_vertices = 1000; ///< the start map is made on the finest level with at most so many
    robust_start_params start = {};
    /// Initial map of a level in place of that of robust_start, if it has to satisfy constraints.
    std::function<start_map(std::size_t level)> first_map = {};
    /// Springs on a level, in its numbering; their vertices are on all levels, and move by minimisation alone.
    std::function<std::vector<directed_spring<2>>(std::size_t level)> springs = {};
    /// Solver of a level. `base` is set to the energy at rest, so that nearly developable surfaces are
    /// solved to enough digits.
    solve::params solve = {.method = solve::method::newton,
                           .gradient_tolerance = 1e-6,
                           .decrease_tolerance = 5e-3,
                           .max_iterations = 100,
                           .tuning = {.stopping = {.decrease_count = 1}}};
    /// Number of consecutive small decreases that end a level of at most so many vertices: iterations are cheap there,
    /// and extreme shapes (long tubes) pause.
    std::size_t small_vertices = 4000;
    int small_decrease_count = 3;
    /// Slow convergence: a coarse level that takes so many iterations, and ends at an energy of more than `hard_above`
    /// times that at rest, ends the nested iteration; 0: never. It is restarted with the coarsening ratio
    /// `patient_factor` and levels minimised to `patient_decrease`. On meshes with fewer than `hard_vertices` that
    /// saves no time.
    int hard_from = 0;
    static constexpr double hard_above = 1.5, patient_decrease = 2e-5, patient_factor = 4;
    static constexpr std::size_t hard_vertices = 30000;

    /// Parameters for slow convergence: coarsening ratio `patient_factor` and tighter tolerances.
    nested_params patient() const
    {
        nested_params p = *this;
        p.hard_from = 0;
        p.solve.decrease_tolerance = patient_decrease;
        p.small_decrease_count = 1; // no pause is taken for an end at that tolerance
        return p;
    }

    /// Level of the start map.
    std::size_t first_level(const mesh_levels<triangle>& levels) const
    {
        std::size_t l = 0;
        while (l + 1 < levels.size() && levels.vertices(l) > start_vertices) ++l;
        return l;
    }
};

/// Nested iteration on surfaces: a start map on a coarse level, minimised, and then for each finer level its vertices
/// reinserted without flips, the worst elements relaxed, and the map minimised again. It needs no map of the fine mesh
/// to begin with and hands the fine level one that lacks detail only (the paper's coarse-to-fine scheme, its section
/// 5).
class nested_iteration
{
public:
    /// Refers to the levels and the solver.
    nested_iteration(const mesh_levels<triangle>& levels, level_solver<triangle>& solver, nested_params params)
        : levels_(levels), solver_(solver), params_(std::move(params))
    {
        params_.solve.tuning.stopping.base = solver.energy_at_rest();
    }

    /// Computes a map of the finest level, minimised down to level 1, in the numbering of level 0; empty where it
    /// failed, with a reason(). plan: that of a level; called for each level but the finest, coarse ones first.
    std::vector<vec2> run(const std::function<observer(std::size_t level)>& ask,
                          const std::function<level_solver<triangle>::plan(std::size_t level)>& plan)
    {
        const std::size_t first = params_.first_level(levels_);
        start_ = params_.first_map ? params_.first_map(first) : robust_start(levels_.level(first), params_.start);
        stages_.add({.stage = "start", .level = first, .vertices = levels_.vertices(first)});
        if (!start_.flips) return fail("the coarse start has " + describe_defects<triangle>(start_.flips));
        auto uv = std::move(start_.uv);
        const std::vector<char> still = still_vertices();
        const auto stopped = [this] { return params_.start.proceed && !params_.start.proceed(); };
        if (params_.start.fixed_boundary && !params_.first_map)
            impl::scale_outline(levels_.hierarchy(), first, levels_.points(), uv);
        for (std::size_t l = first; l > 0; --l)
        {
            if (stopped()) return fail("it was stopped");
            uv = minimised(l, plan(l), uv, l < first, ask(l));
            if (stopped()) return fail("it was stopped");
            if (reports_.back().solve.stop == solve::stop::not_finite_start)
                return fail("the energy is not finite on level " + std::to_string(l));
            hard_ = is_hard(reports_.back().solve);
            if (hard_) return fail("level " + std::to_string(l) + " is hard");
            auto finer = impl::raise_map(levels_.hierarchy(), l - 1, levels_.points(), std::move(uv), {.fixed = still});
            stages_.add({.stage = "reinsert",
                         .level = l - 1,
                         .vertices = levels_.vertices(l - 1),
                         .energy_before = finer.energy.before,
                         .energy_after = finer.energy.after});
            if (!std::isfinite(finer.energy.after))
                return fail("not all vertices could be reinserted on level " + std::to_string(l - 1));
            uv = std::move(finer.uv);
        }
        return uv;
    }

    /// Report of the start map; its uv have been moved from.
    const start_map& start() const { return start_; }
    const std::string& reason() const { return reason_; }
    bool hard() const { return hard_; } ///< it ended for that
    const std::vector<level_report>& reports() const { return reports_; }
    const std::vector<stage_report>& stages() const { return stages_.stages(); }

private:
    bool is_hard(const solve::report& r) const
    {
        const double rest = params_.solve.tuning.stopping.base;
        return params_.hard_from > 0 && r.iterations >= params_.hard_from && rest > 0 &&
               r.value > nested_params::hard_above * rest;
    }

    /// Flags of the vertices that reinsertion may not move; none at all where the map may be scaled, too.
    std::vector<char> still_vertices() const
    {
        std::vector<char> still;
        if (levels_.pinned()) still.assign(levels_.fixed(0).begin(), levels_.fixed(0).end());
        if (!params_.springs) return still;
        still.resize(levels_.vertices(0), char(0));
        for (const auto& s : params_.springs(0)) still[static_cast<std::size_t>(s.vertex)] = 1;
        return still;
    }

    std::vector<vec2> minimised(std::size_t l, level_solver<triangle>::plan host, const std::vector<vec2>& uv,
                                bool relax, const observer& ask)
    {
        point_constraints<2> asked;
        if (params_.springs) asked.springs = params_.springs(l);
        level_solver<triangle>::level level(solver_, std::move(host), uv, asked);
        if (relax && params_.solve.max_iterations > 0) level.relax();
        auto how = params_.solve;
        if (levels_.vertices(l) <= params_.small_vertices)
            how.tuning.stopping.decrease_count = params_.small_decrease_count;
        stages_.add({.stage = "prepare", .level = l, .vertices = levels_.vertices(l)});
        auto r = level.minimize(how, {.observer = ask});
        auto did = stage_of("minimise", l, levels_.vertices(l), r);
        if (!r.capping.empty()) did.cut_by = corners_of(levels_.cells(l), r.capping, levels_.users(l));
        stages_.add(std::move(did));
        r.history.clear();
        reports_.push_back({.level = l, .vertices = levels_.vertices(l), .solve = std::move(r)});
        return level.download();
    }

    std::vector<vec2> fail(std::string why)
    {
        reason_ = std::move(why);
        return {};
    }

    const mesh_levels<triangle>& levels_;
    level_solver<triangle>& solver_;
    nested_params params_;
    start_map start_;
    std::string reason_;
    bool hard_ = false;
    std::vector<level_report> reports_;
    stage_log stages_; // made with this, which is to be run at once
};

} // namespace taut::impl
