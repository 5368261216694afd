// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include <taut/certify.hpp>

namespace taut::impl
{

/// Counts the collapsed triangles of a surface in space as `flipped` in a certificate; det is mapped / rest area.
///
/// cells: #F by 3 vertex indices, in range; rest, x: #V points; max_ids: maximum number of collapsed triangles to list
inline certificate certify_surface(std::span<const std::array<idx, 3>> cells, std::span<const vec3> rest,
                                   std::span<const vec3> x, std::size_t max_ids = 16)
{
    certificate found{.elements = cells.size(), .min_det = std::numeric_limits<double>::infinity()};
    for (std::size_t f = 0; f < cells.size(); ++f)
    {
        const auto area = [&](std::span<const vec3> p)
        {
            const vec3 a = p[static_cast<std::size_t>(cells[f][0])], b = p[static_cast<std::size_t>(cells[f][1])],
                       c = p[static_cast<std::size_t>(cells[f][2])];
            return glm::length(glm::cross(b - a, c - a));
        };
        const auto at = [&](std::size_t k) { return x[static_cast<std::size_t>(cells[f][k])]; };
        if (collapsed(at(0), at(1), at(2)))
        {
            ++found.flipped;
            if (found.ids.size() < max_ids) found.ids.push_back(static_cast<idx>(f));
        }
        const double ratio = area(x) / area(rest);
        found.min_det = std::min(found.min_det, ratio);
        found.max_det = std::max(found.max_det, ratio);
    }
    if (cells.empty()) found.min_det = 0;
    return found;
}

} // namespace taut::impl
