// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/map/map_run.hpp>
#include <taut/impl/core/map/run_start.hpp>
#include <taut/impl/core/start/robust.hpp>

namespace taut::impl
{

/// A map of the run's surface whose boundary nowhere meets itself: the user's, if it is one, else one on a convex
/// polygon, brought near to fixed coordinates. Empty where none was found.
inline start_map start_apart(const map_run& run, const std::vector<std::vector<idx>>& loops)
{
    const auto& in = run.in;
    const auto usable = [&](const start_map& map) { return map.flips && boundary_crossings(loops, map.uv) == 0; };
    if (!run.params.initial.empty())
    {
        std::vector<std::string> notes; // they were told before
        start_map given = given_map(in.surface, in.ideal, run.params, in.unit, notes);
        if (usable(given)) return given;
    }
    constexpr double extreme = 1e8; // isometric energy: beyond, triangles are flat to the precision of numbers
    const auto proceed = [&run] { return run.clock.proceed(); };
    start_map map = barycentric_map(in.surface, in.sides, run.params.barycentric(), elimination_solver(), proceed);
    if ((!usable(map) || map.distortion.measure > extreme) && run.vertices() <= largest_direct)
    {
        start_map other = robust_start(
            in.surface, {.boundary = run.params.barycentric().boundary, .fixed_boundary = true, .proceed = proceed});
        if (usable(other) && (!usable(map) || better(other, map))) map = std::move(other);
    }
    run.held.bring_near(map.uv);
    assess(map, in.surface, in.ideal);
    return usable(map) ? map : start_map();
}

} // namespace taut::impl
