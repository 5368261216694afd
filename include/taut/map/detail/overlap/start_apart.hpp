// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <taut/exact/crossings.hpp>
#include <taut/map/detail/map_run.hpp>
#include <taut/start/robust.hpp>

namespace taut::detail
{

/// A map of the run's surface whose boundary nowhere meets itself, on a convex polygon, brought near to what is held;
/// empty where none was found.
template <class Element>
start_map start_apart(const map_run<Element>& run, const std::vector<std::vector<idx>>& loops)
{
    const auto& in = run.in;
    const auto proceed = [&run] { return run.clock.proceed(); };
    const auto usable = [&](const start_map& map) { return map.flips && boundary_crossings(loops, map.uv) == 0; };
    auto how = run.params.barycentric;
    how.proceed = proceed;
    start_map map = barycentric_map(in.surface, in.sides, how);
    if (!usable(map) && run.vertices() <= largest_direct)
        map = robust_start(in.surface, {.boundary = how.boundary, .fixed_boundary = true, .proceed = proceed});
    if (!usable(map)) return {};
    run.held.bring_near(map.uv);
    map.assess(in.surface, in.ideal);
    return usable(map) ? map : start_map();
}

} // namespace taut::detail
