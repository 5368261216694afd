// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/error.hpp>
#include <taut/impl/core/types.hpp>
#include <taut/impl/exact/predicates.hpp>
#include <taut/impl/start/barycentric_params.hpp>

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
inline std::vector<vec2> on_square(std::span<const double> gaps,
                                   std::span<const std::pair<std::size_t, std::size_t>> dividing)
{
    const std::size_t n = gaps.size();
    auto corner = square_corners(gaps, 0);
    auto flat = flat_sides(corner, dividing);
    const auto total = [](const std::array<int, 4>& c) { return c[0] + c[1] + c[2] + c[3]; };
    // Starts beyond the first quarter would repeat the same squares, up to rounding to vertices.
    const std::size_t limit = dividing.empty() ? 0 : std::min<std::size_t>(corner[1], 1000);
    for (std::size_t start = 1; start < limit && total(flat) > 0; ++start)
    {
        const auto other = square_corners(gaps, start);
        if (const auto count = flat_sides(other, dividing); total(count) < total(flat))
        {
            corner = other;
            flat = count;
        }
    }

    constexpr double bulge = 0.1; // height of the parabola over half a side: corners stay well below 180 degrees
    constexpr std::array<std::array<double, 4>, 4> frame{
        {{-1, -1, 1, 0}, {1, -1, 0, 1}, {1, 1, -1, 0}, {-1, 1, 0, -1}}};
    std::vector<vec2> p(n);
    for (std::size_t side = 0; side < 4; ++side)
    {
        const vec2 origin(frame[side][0], frame[side][1]);
        const vec2 along(frame[side][2], frame[side][3]);
        const vec2 outward(along.y, -along.x);
        double length = 0;
        for (std::size_t k = corner[side]; k < corner[side + 1]; ++k) length += gaps[k % n];
        double s = 0;
        for (std::size_t k = corner[side]; k < corner[side + 1]; ++k)
        {
            const double t = s / length;
            p[k % n] = origin + 2 * t * along;
            if (flat[side] > 0) p[k % n] += 4 * t * (1 - t) * bulge * outward;
            s += gaps[k % n];
        }
    }
    return p;
}

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
inline std::vector<vec2> boundary_polygon(std::span<const vec3> loop, const boundary_params& params, double area,
                                          std::span<const std::pair<std::size_t, std::size_t>> dividing = {})
{
    if (loop.size() < 3) throw parameter_error("loop", "a boundary loop has at least three vertices");
    if (!(area > 0) || !std::isfinite(area)) throw parameter_error("area", "must be positive and finite");
    const bool square = params.shape == boundary_shape::square && loop.size() > 3;
    for (double even = 0;; even = even == 0 ? 1e-6 : std::min(1.0, even * 10))
    {
        const auto gaps = impl::boundary_gaps(loop, params.spacing, even);
        auto p = square ? impl::on_square(gaps, dividing) : impl::on_circle(gaps);
        const double scale = std::sqrt(2 * area / impl::polygon_area2(p));
        for (auto& q : p) q *= scale;
        if (even >= 1 || impl::convex(p, square)) return p;
    }
}

} // namespace taut::impl
