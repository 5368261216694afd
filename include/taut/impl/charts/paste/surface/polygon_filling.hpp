// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/exact/crossings.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Returns whether a simple polygon has p inside or on it; exact.
inline bool encloses(std::span<const vec2> polygon, const vec2& p)
{
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
        const vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        if ((a.y > p.y) == (b.y > p.y)) continue;
        const int side = a.y < b.y ? orient2d(a, b, p) : orient2d(b, a, p);
        if (side == 0) return true;
        if (side > 0) inside = !inside;
    }
    return inside;
}

/// The distance of p from the edges of a polygon.
inline double distance_from(std::span<const vec2> polygon, const vec2& p)
{
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
        const vec2 a = polygon[i], along = polygon[(i + 1) % polygon.size()] - a;
        const double t = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
        nearest = std::min(nearest, glm::distance(p, a + t * along));
    }
    return nearest;
}

/// Fills the polygon with counter-clockwise triangles of its corners: ear clipping with exact predicates, O(n^2) at
/// worst. The polygon may run along an edge twice, there and back, as a bridge to a hole does. Returns fewer than n - 2
/// triangles where it crosses itself.
inline std::vector<std::array<idx, 3>> clip_ears(std::vector<idx> polygon, std::span<const vec2> x)
{
    const auto at = [&](idx v) -> const vec2& { return x[static_cast<std::size_t>(v)]; };
    const auto is_ear = [&](std::size_t i)
    {
        const std::size_t n = polygon.size();
        const idx a = polygon[(i + n - 1) % n], b = polygon[i], c = polygon[(i + 1) % n];
        if (a == c || orient2d(at(a), at(b), at(c)) <= 0) return false;
        const vec2 low = glm::min(at(a), glm::min(at(b), at(c))), high = glm::max(at(a), glm::max(at(b), at(c)));
        for (const idx v : polygon)
        {
            const vec2& p = at(v);
            if (v == a || v == b || v == c || p.x < low.x || p.x > high.x || p.y < low.y || p.y > high.y) continue;
            if (orient2d(at(a), at(b), p) >= 0 && orient2d(at(b), at(c), p) >= 0 && orient2d(at(c), at(a), p) >= 0)
                return false;
        }
        return true;
    };
    std::vector<std::array<idx, 3>> triangles;
    std::size_t i = 0, passed = 0;
    while (polygon.size() > 3 && passed < polygon.size())
    {
        const std::size_t n = polygon.size();
        i %= n;
        if (!is_ear(i))
        {
            ++i;
            ++passed;
            continue;
        }
        triangles.push_back({polygon[(i + n - 1) % n], polygon[i], polygon[(i + 1) % n]});
        polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(i));
        passed = 0;
    }
    if (polygon.size() == 3 && orient2d(at(polygon[0]), at(polygon[1]), at(polygon[2])) > 0)
        triangles.push_back({polygon[0], polygon[1], polygon[2]});
    return triangles;
}

/// One polygon of an outer loop (counter-clockwise) and a hole in it (given counter-clockwise, too), joined by a bridge
/// between two corners that see each other: the shortest one of those tried. Empty if there is none.
inline std::vector<idx> bridged(std::span<const idx> outer, std::span<const idx> hole, std::span<const vec2> x)
{
    const auto at = [&](idx v) -> const vec2& { return x[static_cast<std::size_t>(v)]; };
    struct bridge
    {
        double length;
        std::size_t from, to;
    };
    std::vector<bridge> bridges;
    for (std::size_t i = 0; i < outer.size(); ++i)
        for (std::size_t j = 0; j < hole.size(); ++j)
            bridges.push_back({glm::distance(at(outer[i]), at(hole[j])), i, j});
    std::sort(bridges.begin(), bridges.end(), [](const bridge& a, const bridge& b) { return a.length < b.length; });
    const auto is_free = [&](const bridge& b, std::span<const idx> loop)
    {
        const idx from = outer[b.from], to = hole[b.to];
        for (std::size_t k = 0; k < loop.size(); ++k)
        {
            const idx p = loop[k], q = loop[(k + 1) % loop.size()];
            if (edges_meet({from, to}, {p, q}, x)) return false;
        }
        return true;
    };
    for (const bridge& b : bridges)
    {
        if (!is_free(b, outer) || !is_free(b, hole)) continue;
        std::vector<idx> polygon;
        for (std::size_t k = 0; k <= outer.size(); ++k) polygon.push_back(outer[(b.from + k) % outer.size()]);
        for (std::size_t k = 0; k <= hole.size(); ++k) // clockwise
            polygon.push_back(hole[(b.to + hole.size() - k % hole.size()) % hole.size()]);
        return polygon;
    }
    return {};
}

} // namespace taut::impl
