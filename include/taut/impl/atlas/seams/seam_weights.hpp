// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/mesh/facets.hpp>

namespace taut::impl
{

/// Cost of a seam along each side: the length of the edge, less along creases, where it is hardly visible. The same
/// on both sides of an edge. factors: of that, one a side, or empty
inline std::vector<double> seam_weights(const mesh<triangle>& m, const facet_table& f,
                                        std::span<const double> factors = {})
{
    constexpr double least = 0.1; // of the length, where an edge is as sharp as a cube's
    std::vector<vec3> normals(m.cells().size());
    std::vector<double> weights(f.twin.size());
    parallel_for(normals.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t c = begin; c < end; ++c)
                     {
                         const auto x = m.rest(static_cast<idx>(c));
                         const vec3 n = glm::cross(x[1] - x[0], x[2] - x[0]);
                         const double length = glm::length(n);
                         normals[c] = length > 0 ? n / length : vec3(0.0);
                     }
                 });
    parallel_for(weights.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t s = begin; s < end; ++s)
                     {
                         const auto side = side_vertices(m, static_cast<idx>(s));
                         const double length = glm::distance(m.points()[static_cast<std::size_t>(side[0])],
                                                             m.points()[static_cast<std::size_t>(side[1])]);
                         const auto t = static_cast<std::size_t>(std::max(f.twin[s], 0)) / 3;
                         const double cosine = f.twin[s] < 0 ? 1 : std::max(0.0, glm::dot(normals[s / 3], normals[t]));
                         weights[s] =
                             length * (least + (1 - least) * cosine * cosine) * (factors.empty() ? 1 : factors[s]);
                     }
                 });
    return weights;
}

} // namespace taut::impl
