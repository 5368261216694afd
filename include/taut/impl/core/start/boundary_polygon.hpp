// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/core/start/barycentric_params.hpp>
#include <taut/start_map.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Gaps between consecutive boundary vertices, sum 1: a mix of the given spacing and, for the fraction `even`, equal
/// gaps.
inline std::vector<double> boundary_gaps(std::span<const vec3> loop, boundary_spacing spacing, double even)
{
    const std::size_t n = loop.size();
    std::vector<double> gap(n, 1.0);
    double total = 0;
    for (std::size_t k = 0; k < n; ++k)
    {
        const double length = glm::length(loop[(k + 1) % n] - loop[k]);
        if (spacing == boundary_spacing::chord) gap[k] = length;
        if (spacing == boundary_spacing::centripetal) gap[k] = std::sqrt(length);
        total += gap[k];
    }
    for (auto& g : gap) g = (1 - even) * g / total + even / static_cast<double>(n);
    return gap;
}

/// Positions on the unit circle, counter-clockwise.
inline std::vector<vec2> on_circle(std::span<const double> gaps)
{
    std::vector<vec2> p;
    double s = 0;
    for (const double g : gaps)
    {
        p.emplace_back(std::cos(2 * std::numbers::pi * s), std::sin(2 * std::numbers::pi * s));
        s += g;
    }
    return p;
}

/// Four distinct boundary positions for the corners, near the quarters of the way round from `start`.
inline std::array<std::size_t, 5> square_corners(std::span<const double> gaps, std::size_t start)
{
    const std::size_t n = gaps.size();
    std::array<std::size_t, 5> corner{start, 0, 0, 0, start + n}; // counted on from start, beyond n at the wrap
    double s = 0;
    std::size_t k = start;
    for (std::size_t c = 1; c < 4; ++c)
    {
        // One vertex at least for each side; stop at the vertex nearest to the quarter.
        s += gaps[k++ % n];
        const double quarter = static_cast<double>(c) / 4;
        while (k + (4 - c) < start + n && s + gaps[k % n] / 2 < quarter) s += gaps[k++ % n];
        corner[c] = k;
    }
    return corner;
}

/// Marks the sides of the square with both ends of an interior edge, which would be mapped to the side.
inline std::array<int, 4> flat_sides(const std::array<std::size_t, 5>& corner,
                                     std::span<const std::pair<std::size_t, std::size_t>> dividing)
{
    std::array<int, 4> count{};
    const std::size_t n = corner[4] - corner[0];
    for (auto [a, b] : dividing)
    {
        if (a < corner[0]) a += n;
        if (b < corner[0]) b += n;
        if (a > b) std::swap(a, b);
        for (std::size_t side = 0; side < 4; ++side)
        {
            const bool last = side == 3 && a == corner[0]; // the first corner also ends the last side
            if ((a >= corner[side] && b <= corner[side + 1]) || (last && b >= corner[3])) ++count[side];
        }
    }
    return count;
}

/// Positions on the square [-1, 1]^2, corners at vertices. The start is the vertex that leaves the fewest interior
/// edges with both ends on one side; the sides that keep some are bent outwards to a parabola, strictly convex.
std::vector<vec2> on_square(std::span<const double> gaps,
                            std::span<const std::pair<std::size_t, std::size_t>> dividing);

/// Twice the signed area.
inline double polygon_area2(std::span<const vec2> p)
{
    double sum = 0;
    for (std::size_t k = 0; k < p.size(); ++k)
    {
        const vec2& q = p[(k + 1) % p.size()];
        sum += p[k].x * q.y - p[k].y * q.x;
    }
    return sum;
}

/// True if the polygon turns left, or straight on where that is allowed, at every vertex and moves on at every edge.
inline bool convex(std::span<const vec2> p, bool straight_allowed)
{
    const std::size_t n = p.size();
    for (std::size_t k = 0; k < n; ++k)
    {
        const vec2& b = p[(k + 1) % n];
        const int turn = orient2d(p[k], b, p[(k + 2) % n]);
        if (turn < 0 || (turn == 0 && !straight_allowed) || p[k] == b) return false;
    }
    return true;
}

/// Image of a boundary loop: a convex polygon about the origin, counter-clockwise, of the given area.
///
/// loop:     n >= 3 positions along the boundary, in its order
/// dividing: interior edges with both ends on the loop, as positions in the loop; they decide about square sides
///
/// On a circle the polygon is strictly convex; tiny gaps that rounding would flatten are evened out, just enough. A
/// square needs four vertices, three are laid on a circle; its sides are straight unless a dividing edge has both ends
/// on one, which would map triangles to nothing.
std::vector<vec2> boundary_polygon(std::span<const vec3> loop, const boundary_params& params, double area,
                                   std::span<const std::pair<std::size_t, std::size_t>> dividing = {});

} // namespace taut::impl
