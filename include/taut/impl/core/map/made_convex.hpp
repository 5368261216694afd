// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/exact/convex_polygons.hpp>
#include <taut/impl/core/map/map_run.hpp>
#include <taut/impl/core/measure/distortion.hpp>
#include <taut/impl/core/untangle/convex_corners.hpp>
#include <taut/parameterize.hpp>
#include <taut/quality.hpp>

namespace taut::impl
{

/// Makes polygons of a solved map convex that are so in space (parameterize_params::polygons).
inline map_result made_convex(const map_run& run, map_result r)
{
    if (!r || run.params.polygons.empty()) return r;
    const auto& m = run.in.surface;
    const auto polygons = find_convex_polygons(m.cells(), run.params.polygons, m.points());
    const auto proceed = [&run] { return run.clock.proceed(); };
    const auto held_to = [&](const fixed_marks<2>& held)
    {
        auto x = r.uv;
        const bool changed = convex_corners(m, run.params.polygons, polygons, held, proceed).make_convex(x);
        return changed ? std::move(x) : std::vector<vec2>();
    };
    auto x = held_to(run.held.marks());
    if (!x.empty() && run.params.no_overlap)
        if (const auto loops = boundary_loops(m, run.in.sides); boundary_crossings(loops, x) > 0)
        {
            auto held = run.held.marks().empty() ? fixed_marks<2>(run.vertices()) : run.held.marks();
            for (const auto& loop : loops)
                for (const idx v : loop) held[static_cast<std::size_t>(v)] = fixed_marks<2>::every;
            x = held_to(held);
        }
    run.clock.spent(&map_seconds::solve);
    r.report.seconds = run.clock.seconds;
    if (x.empty()) return r;
    r.uv = std::move(x);
    r.report.flips = certify<2>(m.cells(), r.uv, run.in.ideal.measure);
    if (!run.params.data.empty()) return r;
    const means e =
        mean_over<triangle>(m, run.in.ideal, r.uv,
                            [&run](const element<double, 2>& here) {
                                return here.det > 0 ? run.params.energy(here) : std::numeric_limits<double>::infinity();
                            });
    r.report.solve.value = run.params.weights == energy::weighting::measure ? e.measure : e.uniform;
    return r;
}

/// Reports the polygons that are convex in space but not in the map.
inline void tell_concave(const map_run& run, map_result& r)
{
    if (!r || run.params.polygons.empty()) return;
    const auto polygons = find_convex_polygons(run.in.surface.cells(), run.params.polygons, run.in.surface.points());
    for (const idx k : find_concave(polygons, r.uv))
        r.report.concave.push_back(polygons.numbers[static_cast<std::size_t>(k)]);
    std::sort(r.report.concave.begin(), r.report.concave.end());
    if (const auto n = r.report.concave.size(); n > 0)
        r.report.notes.push_back(std::to_string(n) + (n == 1 ? " polygon is" : " polygons are") +
                                 " not convex in the map, though in space; cut along other diagonals, triangles of "
                                 "them turn over");
}

} // namespace taut::impl
