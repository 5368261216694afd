// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <taut/impl/exact/certify.hpp>

namespace taut
{

/// Returns whether the corners of a triangle in space are collinear or not finite: its projections on all three
/// coordinate planes are flat. Exact.
inline bool collapsed(const vec3& a, const vec3& b, const vec3& c)
{
    for (const vec3& p : {a, b, c})
        if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))) return true;
    for (int k = 0; k < 3; ++k)
    {
        const auto flat = [i = (k + 1) % 3, j = (k + 2) % 3](const vec3& p) { return vec2(p[i], p[j]); };
        if (impl::orient2d(flat(a), flat(b), flat(c)) != 0) return false;
    }
    return true;
}

} // namespace taut

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
