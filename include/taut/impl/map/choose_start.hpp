// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include <taut/impl/map/drawn_start.hpp>
#include <taut/impl/map/fitted_start.hpp>
#include <taut/impl/map/given_map.hpp>
#include <taut/impl/start/conformal.hpp>

namespace taut::impl
{

/// Computes the map of a run without the constraints; none if that has no valid one. Defined in mapped.hpp.
inline std::vector<vec2> free_draft(const map_run& run);

/// Chooses the first of these that works: a penalty continuation for pins on levels; where that fails and the boundary
/// is pinned as a whole, the same from the unconstrained map, if a similarity brings that near to the pins; where the
/// boundary is free, that map, brought near; the conformal start, if requested. None: the default start.
inline std::optional<run_start> other_start(const map_run& run)
{
    run_start start;
    if (run.draws_pins())
    {
        start = drawn_start(run).make();
        if (!start.useless || start.stopped) return start;
        if (run.held.outline_pinned(run.in.surface, run.in.sides))
        {
            start = drawn_start(run, drawn_start::from::free_map).make();
            if (!start.useless || start.stopped) return start;
            start.useless = false;
            if (!start.map.uv.empty()) return fitted_start(run, std::move(start), false);
        }
        start = run_start();
    }
    if (run.held.constrained() && run.params.initial.empty() && run.params.boundary == boundary_mode::free &&
        !run.held.outline_pinned(run.in.surface, run.in.sides))
    {
        start.map.uv = free_draft(run);
        if (!start.map.uv.empty()) return fitted_start(run, std::move(start), false);
        start.stopped = !run.clock.proceed();
        if (start.stopped) return start;
    }
    if (run.params.start != start_method::conformal || run.params.boundary != boundary_mode::free) return std::nullopt;
    start.map = conformal_start(run.in.surface, run.in.sides);
    return fitted_start(run, std::move(start), false);
}

/// Computes a start on the finest level: the requested one, or a barycentric one.
inline run_start made_start(const map_run& run)
{
    run_start start;
    if (!run.clock.proceed())
    {
        start.stopped = true;
        return start;
    }
    if (auto other = other_start(run)) return *std::move(other);
    start.map = barycentric_map(run.in.surface, run.in.sides, run.params.barycentric, elimination_solver(),
                                [&run] { return run.clock.proceed(); });
    return fitted_start(run, std::move(start), false);
}

/// Makes a start of the user's coordinates. Throws parameter_error for a wrong number.
inline run_start given_start(const map_run& run)
{
    run_start start;
    start.stopped = !run.clock.proceed();
    if (start.stopped) return start;
    start.map = given_map(run.in.surface, run.in.ideal, run.params, run.in.unit, start.notes);
    return fitted_start(run, std::move(start), true);
}

/// Chooses the start of a run: from the user's coordinates, unless another one is better, else computed on coarser
/// levels or on the finest one.
inline run_start choose_start(const map_run& run)
{
    run_start start;
    if (run.clock.over())
    {
        start.stopped = true;
        return start;
    }
    if (!run.params.initial.empty())
    {
        start = given_start(run);
        if (!start.useless) return start;
        start.useless = false;
        start.stopped = !run.clock.proceed();
        if (start.stopped) return start;
    }
    run_start made;
    if (run.starts_coarse())
        made.coarse = true;
    else
        made = made_start(run);
    made.notes.insert(made.notes.begin(), start.notes.begin(), start.notes.end());
    if (made.untangling.empty()) made.untangling = std::move(start.untangling);
    return made;
}

} // namespace taut::impl
