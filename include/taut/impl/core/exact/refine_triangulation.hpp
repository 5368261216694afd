// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <span>

#include <taut/impl/core/exact/planar_triangulation.hpp>

namespace taut::impl
{

/// Off-centre of a triangle with a small angle: its circumcentre, or a point nearer to its shortest edge that sees it
/// at the minimum angle (Uengoer 2004). None for triangles without small angles.
inline std::optional<vec2> off_centre(const std::array<vec2, 3>& x)
{
    constexpr double longest_radius = 1.4142135623730951; // by the shortest edge: angles of at least 20.7 degrees
    constexpr double farthest = 2.7;                      // from the middle of that edge, by its length
    std::size_t k = 0;                                    // the corner opposite the shortest edge
    const auto edge = [&x](std::size_t i) { return x[(i + 2) % 3] - x[(i + 1) % 3]; };
    for (std::size_t i = 1; i < 3; ++i)
        if (glm::dot(edge(i), edge(i)) < glm::dot(edge(k), edge(k))) k = i;
    const vec2 e = edge(k), to_apex = x[k] - x[(k + 1) % 3], normal(-e.y, e.x);
    const double shortest2 = glm::dot(e, e), det = glm::dot(normal, to_apex);
    if (!(shortest2 > 0 && det > 0)) return std::nullopt;
    // The centre is at the middle + height * normal.
    const double height = 0.5 * glm::dot(to_apex, to_apex - e) / det;
    if (!(0.25 + height * height > longest_radius * longest_radius)) return std::nullopt;
    return x[(k + 1) % 3] + 0.5 * e + std::min(height, farthest) * normal;
}

/// Adds points to chosen triangles of a triangulation until those have no small angles (Delaunay refinement), as far as
/// that is possible without a point on an edge that is fixed. Triangles that are chosen and others are separated by
/// fixed edges. Graded: triangles become as large as their distance from small edges allows.
/// chosen: one flag per triangle; new triangles are chosen, too. most: maximum number of points.
inline void refine(planar_triangulation& t, std::span<const char> chosen, std::size_t most)
{
    std::deque<idx> bad;
    for (std::size_t c = 0; c < chosen.size(); ++c)
        if (chosen[c]) bad.push_back(static_cast<idx>(c));
    while (!bad.empty() && most > 0)
    {
        const idx c = bad.front();
        bad.pop_front();
        std::array<vec2, 3> x;
        for (std::size_t k = 0; k < 3; ++k)
            x[k] = t.points()[static_cast<std::size_t>(t.cells()[static_cast<std::size_t>(c)][k])];
        const auto centre = impl::off_centre(x);
        const idx v = centre ? t.add_from(c, *centre) : planar_triangulation::none;
        if (v == planar_triangulation::none) continue;
        --most;
        t.around(v,
                 [&](idx corner)
                 {
                     bad.push_back(corner / 3);
                     return false;
                 });
    }
}

} // namespace taut::impl
