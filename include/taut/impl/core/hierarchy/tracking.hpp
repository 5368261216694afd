// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include <taut/impl/core/hierarchy/round.hpp>

namespace taut::impl
{

/// Point of the coarse surface that a fine vertex lies on: a triangle and barycentric coordinates.
struct surface_point
{
    std::array<idx, 3> vertices{};
    std::array<double, 3> weights{};
};

/// Position in the flat star: weighted mean of the corners.
inline vec2 position(const surface_point& p, idx centre, std::span<const idx> ring, std::span<const vec2> corner)
{
    vec2 x(0.0);
    for (std::size_t k = 0; k < 3; ++k)
    {
        if (p.weights[k] == 0 || p.vertices[k] == centre) continue; // (the centre is the origin)
        x += p.weights[k] * corner[static_cast<std::size_t>(find(ring, p.vertices[k]))];
    }
    return x;
}

/// The triangle of the fan from corner t that contains x, with the barycentric coordinates there. A point beyond the
/// fan, as the tip of a convex boundary corner is, moves to its edge.
inline surface_point locate(const vec2& x, std::size_t t, std::span<const idx> ring, std::span<const vec2> corner,
                            bool open)
{
    // The fan's triangles (t, i, i + 1) in order, starting after t. Its angle may exceed half a turn, so that each
    // triangle is asked; where none has x between its spokes, the one that x is least outside of.
    const std::size_t n = ring.size();
    const auto at = [n](std::size_t i) { return i < n ? i : i - n; };
    const std::size_t first = open && t + 1 == n ? 0 : t + 1;
    const vec2 apex = corner[t], to = x - apex;
    std::size_t sector = first;
    double wa = 0, wb = 0, most = -std::numeric_limits<double>::infinity();
    vec2 b = corner[at(first)] - apex;
    for (std::size_t i = first; i < first + n - 2; ++i)
    {
        const vec2 a = b;
        b = corner[at(i + 1)] - apex;
        const double whole = cross(a, b), left = cross(to, b), right = cross(a, to);
        const bool between = left >= 0 && right >= 0;
        const double inside = between ? 0 : std::min({left, right, whole - left - right}) / whole;
        if (!(inside > most)) continue;
        most = inside;
        sector = i;
        wa = left / whole;
        wb = right / whole;
        if (between) break;
    }
    constexpr double rounding = 1e-13;
    const auto snap = [](double w) { return w > rounding ? w : 0.0; };
    wa = snap(wa);
    wb = snap(wb);
    surface_point p{{ring[t], ring[at(sector)], ring[at(sector + 1)]}, {snap(1 - wa - wb), wa, wb}};
    const double sum = p.weights[0] + wa + wb;
    for (double& w : p.weights) w /= sum;
    return p;
}

/// Tracks a point through a round. At most one corner of its triangle is removed, and all others are in its star.
inline void follow(const thinning_surface& m, const collapse_round& round, surface_point& p)
{
    for (std::size_t k = 0; k < 3; ++k)
    {
        const auto* const c = p.weights[k] > 0 ? round.removing(p.vertices[k]) : nullptr;
        if (c == nullptr) continue;
        const auto ring = m.rings[c->vertex];
        const auto first = round.first_corner[static_cast<std::size_t>(c - round.collapses.data())];
        const std::span corner(round.corners.data() + first, ring.size());
        p = locate(position(p, c->vertex, ring, corner), static_cast<std::size_t>(c->target), ring, corner,
                   m.open[static_cast<std::size_t>(c->vertex)] != 0);
        return;
    }
}

} // namespace taut::impl
