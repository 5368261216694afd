// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/core/types.hpp>
#include <taut/map/predicates.hpp>

namespace taut
{

namespace detail
{

/// True if r, known to lie on the line through p and q, is on the closed segment.
inline bool between(const vec2& p, const vec2& q, const vec2& r)
{
    return std::min(p.x, q.x) <= r.x && r.x <= std::max(p.x, q.x) && std::min(p.y, q.y) <= r.y &&
           r.y <= std::max(p.y, q.y);
}

/// True if the closed segments ab and cd have a common point; exact.
inline bool segments_meet(const vec2& a, const vec2& b, const vec2& c, const vec2& d)
{
    const int abc = orient2d(a, b, c);
    const int abd = orient2d(a, b, d);
    const int cda = orient2d(c, d, a);
    const int cdb = orient2d(c, d, b);
    if (abc * abd < 0 && cda * cdb < 0) return true;
    return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) || (cda == 0 && between(c, d, a)) ||
           (cdb == 0 && between(c, d, b));
}

/// True if segments ab and bc share more than b: c folds back over ab.
inline bool folds_back(const vec2& a, const vec2& b, const vec2& c)
{
    return orient2d(a, b, c) == 0 && (between(a, b, c) || between(b, c, a));
}

} // namespace detail

/// Number of pairs of boundary edges whose images have a common point beyond a common end vertex: crossings, touchings
/// and overlaps. Exact. 0 together with a clean certificate means that a disk's map is injective.
///
/// loops: boundary loops as vertex indices, each of at least two; x: #V image points, finite.
/// A sweep along the longer side of the bounding box: O(n log n) plus the pairs whose extents overlap.
inline std::size_t boundary_crossings(std::span<const std::vector<index>> loops, std::span<const vec2> x)
{
    struct edge
    {
        std::array<index, 2> ends;
        vec2 low, high;
    };
    std::vector<edge> edges;
    for (const auto& loop : loops)
        for (std::size_t k = 0; k < loop.size(); ++k)
        {
            const index a = loop[k];
            const index b = loop[(k + 1) % loop.size()];
            const vec2 p = x[static_cast<std::size_t>(a)];
            const vec2 q = x[static_cast<std::size_t>(b)];
            edges.push_back({{a, b}, glm::min(p, q), glm::max(p, q)});
        }
    if (edges.empty()) return 0;

    vec2 low = edges.front().low;
    vec2 high = edges.front().high;
    for (const auto& e : edges)
    {
        low = glm::min(low, e.low);
        high = glm::max(high, e.high);
    }
    const int s = high.x - low.x >= high.y - low.y ? 0 : 1; // the sweep goes along s
    const int t = 1 - s;
    std::sort(edges.begin(), edges.end(), [s](const edge& e, const edge& f) { return e.low[s] < f.low[s]; });

    const auto at = [&x](index v) { return x[static_cast<std::size_t>(v)]; };
    const auto conflict = [&at](const edge& e, const edge& f)
    {
        const auto [a, b] = e.ends;
        const auto [c, d] = f.ends;
        if ((a == c && b == d) || (a == d && b == c)) return true;
        if (b == c) return detail::folds_back(at(a), at(b), at(d));
        if (a == d) return detail::folds_back(at(b), at(a), at(c));
        if (a == c) return detail::folds_back(at(b), at(a), at(d));
        if (b == d) return detail::folds_back(at(a), at(b), at(c));
        return detail::segments_meet(at(a), at(b), at(c), at(d));
    };

    std::size_t count = 0;
    std::vector<const edge*> active; // edges whose extent along s may still reach the sweep line
    for (const auto& e : edges)
    {
        std::size_t kept = 0;
        for (const edge* f : active)
        {
            if (f->high[s] < e.low[s]) continue;
            active[kept++] = f;
            if (f->low[t] <= e.high[t] && e.low[t] <= f->high[t] && conflict(e, *f)) ++count;
        }
        active.resize(kept);
        active.push_back(&e);
    }
    return count;
}

} // namespace taut
