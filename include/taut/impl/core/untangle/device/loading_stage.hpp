// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/energies.hpp>
#include <taut/impl/core/constrain/prescribed_paths.hpp>
#include <taut/impl/core/measure/rigid_motion.hpp>
#include <taut/impl/core/objective/running_map.hpp>
#include <taut/impl/core/untangle/stage.hpp>
#include <taut/rigid_motion.hpp>

namespace taut::impl
{

/// Incremental loading: begins with the shape at rest, moved as a whole near to the fixed coordinates, and brings these
/// to their targets by Newton's steps with prescribed displacements: elements stay positive on the way. For handles of
/// a body whose surface is free; it gives up where steps stick.
template <class Element>
class loading_stage final : public untangle_stage<Element>
{
    static constexpr int D = Element::dimension;
    using map = std::vector<vec<D>>;

public:
    explicit loading_stage(queue q) : queue_(std::move(q)) {}

    std::string_view name() const override { return "lead"; }

    bool run(untangle_state<Element>& state, int) override
    {
        const auto& problem = state.problem();
        map x = start(problem);
        if (!certify<D>(state.cells(), std::span<const vec<D>>(x), {}, 0, problem.owners))
            return false; // there is no such shape
        const mapped_mesh<Element> of{.rest = problem.rest, .energy = energy::isometric{}};
        running_map<Element> running(queue_, of);
        running.fixed = {problem.held, problem.initial};
        running.load(x, queue_.device().has_fp64() ? precision::mixed : precision::fp32);

        const prescribed_paths<D> paths(problem.rest.cells(), problem.held, x, problem.initial);
        const int parts = paths.parts();
        for (int part = 1; part <= parts; ++part)
        {
            if (!state.proceed(0)) return false;
            const auto way = [&](std::size_t v) { return paths.place(v, double(part) / parts); };
            running.aim(way);
            const map now = part == 1 ? x : running.coordinates();
            if (const double gap = running.fixed.gap(now, way).distance; gap > 0)
                if (!running.follow(gap, [&](const auto&) { return state.proceed(); }).arrived) return false;
        }
        x = running.coordinates();
        state.take(x);
        return false;
    }

private:
    /// Rest shape, moved rigidly.
    static map start(const untangle_problem<Element>& problem)
    {
        map x(problem.rest.points().begin(), problem.rest.points().end());
        map from, to;
        for (std::size_t v = 0; v < x.size(); ++v)
            if (problem.held.all(v)) from.push_back(x[v]), to.push_back(problem.initial[v]);
        if (from.empty()) return x;
        const auto motion = fit_rigid_motion(std::span<const vec<D>>(from), std::span<const vec<D>>(to));
        for (auto& p : x) p = motion(p);
        return x;
    }

    queue queue_;
};

} // namespace taut::impl
