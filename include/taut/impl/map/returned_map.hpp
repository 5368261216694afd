// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include <taut/impl/compute/queue_counters.hpp>
#include <taut/impl/constrain/place_map.hpp>
#include <taut/impl/map/map_run.hpp>
#include <taut/impl/map/run_result.hpp>

namespace taut::impl
{

/// Places an unconstrained map, or leaves it if rounding would flip a triangle. A map with a fixed boundary is only
/// scaled and translated into the unit square.
inline map_result placed(const map_run& run, map_result r)
{
    const bool fits = run.params.placement == placement::unit_square, free = run.is_free();
    if (!r || run.held.constrained() || run.params.placement == placement::as_solved || (!free && !fits)) return r;
    run.in.set_unused_aside(r.uv);
    const double side = fits ? run.in.unit : 0;
    for (const bool turned : {true, false})
    {
        if (turned && !free) continue;
        auto map = in_corner(turned ? turned_up(run.in.surface, r.uv) : r.uv, side);
        const auto flips = certify<2>(run.in.surface.cells(), map.uv, run.in.ideal.measure);
        if (!flips) continue;
        r.uv = std::move(map.uv);
        r.report.scale = map.scale;
        r.report.flips = flips;
        return r;
    }
    r.report.notes.push_back("rounding would flip triangles of the map in its place; it stays where it was solved");
    return r;
}

/// Converts a map to the user's units, pins bit for bit; the division is inexact at the ends of the range of double, so
/// a valid map is certified again.
inline map_result in_user_units(const map_run& run, map_result r)
{
    for (auto* points : {&r.uv, &r.report.start.uv})
        if (!points->empty()) run.in.set_unused_aside(*points);
    for (auto* points : {&r.uv, &r.report.start.uv, &r.report.pin_origins})
        for (vec2& p : *points) p /= run.in.unit;
    if (!r.uv.empty()) run.held.impose(r.uv, 1);
    if (!r) return r;
    r.report.flips.take_defects(certify<2>(run.in.surface.cells(), r.uv));
    if (r.report.flips) return r;
    const auto why = refuse(outcome::gave_up,
                            "the map in the units of the surface, which are too large or small for double "
                            "precision,",
                            r.report.flips);
    return refused(std::move(r), why);
}

} // namespace taut::impl
