// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/constrain/prescribed_paths.hpp>
#include <taut/impl/energy/isometric.hpp>
#include <taut/impl/measure/rigid_motion.hpp>
#include <taut/impl/untangle/device/live_map.hpp>
#include <taut/impl/untangle/stage.hpp>

namespace taut::impl
{

/// Incremental loading: begins with the shape at rest, moved as a whole near to the fixed coordinates, and brings these
/// to their targets by Newton's steps with prescribed displacements: elements stay positive on the way. For handles of
/// a body whose surface is free; it gives up where steps stick.
template <class Element>
class lead_stage final : public untangle_stage<Element>
{
    static constexpr int D = Element::dimension;
    using map = std::vector<vec<D>>;

public:
    explicit lead_stage(queue q) : queue_(std::move(q)) {}

    std::string_view name() const override { return "lead"; }

    bool run(untangle_state<Element>& state, int) override
    {
        const auto& problem = state.problem();
        map x = start(problem);
        if (!certify<D>(state.cells(), std::span<const vec<D>>(x), {}, 0, problem.owners))
            return false; // there is no such shape
        struct
        {
            any_energy energy = energy::isometric{};
            energy::weighting weights = energy::weighting::measure;
            cell_data data = {};
        } const params;
        const precision how = queue_.device().has_fp64() ? precision::mixed : precision::fp32;
        impl::live_map<Element> live(queue_, problem.rest, params, how, x);
        live.constrain(problem.held, {}, {});

        const prescribed_paths<D> paths(problem.rest.cells(), problem.held, x, problem.initial);
        for (int part = 1; part <= paths.parts(); ++part)
        {
            if (!state.proceed(0)) return false;
            map way = problem.initial;
            paths.place(static_cast<double>(part) / paths.parts(), way);
            live.aim(way);
            if (const double gap = largest_gap(problem.held, x, way); gap > 0)
                if (!live.follow(gap, [&](const auto&) { return state.proceed(); }).arrived) return false;
            x = live.coordinates();
        }
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

    static double largest_gap(const fixed_marks<D>& marks, const map& x, const map& way)
    {
        double most = 0;
        for (std::size_t v = 0; v < x.size(); ++v)
            for (int k = 0; k < D; ++k)
                if (marks.test(v, k)) most = std::max(most, std::abs(way[v][k] - x[v][k]));
        return most;
    }

    queue queue_;
};

} // namespace taut::impl
