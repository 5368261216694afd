// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/facets.hpp>
#include <taut/impl/core/start/boundary_polygon.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Interior edges with both ends on one loop, as positions in it.
std::vector<std::pair<std::size_t, std::size_t>> dividing_edges(const mesh<triangle>& m, const facet_table& f,
                                                                const std::vector<idx>& loop);

/// Spans a hole by a cone: an apex above the loop's centroid, so that no triangle of it is flat.
void span_hole(const std::vector<idx>& loop, std::vector<vec3>& points, std::vector<std::array<idx, 3>>& cells);

/// Boundary loop that becomes the outline.
inline std::size_t longest_loop(std::span<const vec3> points, std::span<const std::vector<idx>> loops)
{
    std::size_t best = 0;
    double longest = -1;
    for (std::size_t l = 0; l < loops.size(); ++l)
    {
        double length = 0;
        for (std::size_t k = 0; k < loops[l].size(); ++k)
            length += glm::distance(points[static_cast<std::size_t>(loops[l][k])],
                                    points[static_cast<std::size_t>(loops[l][(k + 1) % loops[l].size()])]);
        if (length > longest) best = l;
        longest = std::max(longest, length);
    }
    return best;
}

} // namespace taut::impl
