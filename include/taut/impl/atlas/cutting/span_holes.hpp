// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <taut/impl/atlas/cutting/coarse_surface.hpp>
#include <taut/impl/mesh/boundary.hpp>

namespace taut::impl
{

/// Spans small holes by cones, so that seams and maps are as if there were none. The apices come after all vertices
/// and have no origin. Returns the number of the first triangle of a cone.
inline idx span_small_holes(coarse_surface& s)
{
    constexpr double small = 0.35; // perimeter by the root of the area; that of a disk is 3.5
    const mesh<triangle> m(s.points, s.cells);
    const auto first = static_cast<idx>(s.cells.size());
    double area = 0;
    for (idx c = 0; c < first; ++c)
    {
        const auto x = m.rest(c);
        area += glm::length(glm::cross(x[1] - x[0], x[2] - x[0])) / 2;
    }
    for (const auto& loop : boundary_loops(m, facets(m)))
    {
        const auto point = [&](std::size_t k) { return s.points[static_cast<std::size_t>(loop[k % loop.size()])]; };
        double perimeter = 0;
        vec3 centre(0.0);
        for (std::size_t k = 0; k < loop.size(); ++k)
        {
            perimeter += glm::distance(point(k), point(k + 1));
            centre += point(k) / static_cast<double>(loop.size());
        }
        if (!(perimeter * perimeter < small * small * area)) continue;
        const auto apex = static_cast<idx>(s.points.size());
        s.points.push_back(centre);
        for (std::size_t k = 0; k < loop.size(); ++k) s.cells.push_back({loop[(k + 1) % loop.size()], loop[k], apex});
    }
    return first;
}

} // namespace taut::impl
