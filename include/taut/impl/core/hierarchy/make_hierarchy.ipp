// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include <taut/impl/core/hierarchy/make_hierarchy.hpp>

namespace taut::impl
{

hierarchy<triangle> make_hierarchy(const mesh<triangle>& m, std::span<const char> keep, const hierarchy_params& params)
{
    params.validate();
    const std::size_t n = m.points().size();
    if (!keep.empty() && keep.size() != n) throw parameter_error("keep", "must have one flag a vertex, or none");

    hierarchy<triangle> h;
    h.levels.push_back({std::vector<idx>(n), m.cells()});
    std::iota(h.levels[0].vertices.begin(), h.levels[0].vertices.end(), 0);
    impl::thinning_surface surface;
    // In units of the model, so that no square leaves the range of numbers; a power of two changes no decision.
    surface.points = m.points();
    const double unit = unit_scale(m);
    for (vec3& p : surface.points) p *= unit;
    surface.keep.assign(n, 0);
    std::copy(keep.begin(), keep.end(), surface.keep.begin());
    surface.rings = impl::make_rings(m.cells(), n, surface.open, params.threads);

    for (;;)
    {
        impl::thinning work(std::move(surface), params.threads);
        const double size = static_cast<double>(work.alive()), least = params.min_vertices;
        if (!(size > 1.5 * least)) break;
        work.run(static_cast<std::size_t>(std::lround(std::max(size / params.factor, least))), params.proceed);
        if (params.proceed && !params.proceed()) break;
        if (static_cast<double>(work.alive()) > 0.8 * size) break; // another level would cost more than it helps

        surface = work.coarse();
        std::vector<idx> vertices;
        for (const idx v : work.remaining()) vertices.push_back(h.levels.back().vertices[static_cast<std::size_t>(v)]);
        h.levels.push_back({std::move(vertices), impl::ring_cells(surface.rings, surface.open)});
        auto [interpolation, removed] = work.result();
        h.steps.push_back({std::move(interpolation), std::move(removed)});
    }
    return h;
}

} // namespace taut::impl
