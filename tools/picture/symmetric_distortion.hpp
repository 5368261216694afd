// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/types.hpp>

namespace taut::io
{

/// The symmetric distortion of each face: max(sigma_max, 1 / sigma_min) of the map surface -> plane, >= 1, and 1 only
/// for an isometry; +infinity where the image has no area, NaN where an input is not finite or the rest triangle has no
/// area. A flip does not show in it: |sigma| counts.
/// Source: Sorkine et al., "Bounded-distortion piecewise mesh parameterization", 2002.
inline std::vector<double> symmetric_distortion(std::span<const vec3> points, std::span<const std::array<idx, 3>> cells,
                                                std::span<const vec2> uv)
{
    std::vector<double> out;
    out.reserve(cells.size());
    for (const auto& cell : cells)
    {
        const auto i = static_cast<std::size_t>(cell[0]), j = static_cast<std::size_t>(cell[1]),
                   k = static_cast<std::size_t>(cell[2]);
        const std::size_t n = std::min(points.size(), uv.size());
        if (i >= n || j >= n || k >= n)
        {
            out.push_back(std::numeric_limits<double>::quiet_NaN());
            continue;
        }
        // Rest triangle in its own plane: (0, 0), (length, 0), (x, y).
        const vec3 e = points[j] - points[i], f = points[k] - points[i];
        const double length = glm::length(e), x = glm::dot(e, f) / length, y = glm::length(glm::cross(e, f)) / length;
        // Columns of the Jacobian of rest -> uv.
        const vec2 s = (uv[j] - uv[i]) / length, t = ((uv[k] - uv[i]) - x * s) / y;
        const double sum = std::hypot(s.x + t.y, s.y - t.x), difference = std::hypot(s.x - t.y, s.y + t.x);
        const double largest = (sum + difference) / 2, smallest = std::abs(sum - difference) / 2;
        const bool known = std::isfinite(largest) && y > 0;
        out.push_back(known ? std::max(largest, 1 / smallest) : std::numeric_limits<double>::quiet_NaN());
    }
    return out;
}

} // namespace taut::io
