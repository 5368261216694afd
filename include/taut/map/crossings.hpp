// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
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

/// True if the images of two edges have a common point beyond a common end vertex.
inline bool edges_meet(const std::array<index, 2>& e, const std::array<index, 2>& f, std::span<const vec2> x)
{
    const auto at = [&x](index v) { return x[static_cast<std::size_t>(v)]; };
    const auto [a, b] = e;
    const auto [c, d] = f;
    if ((a == c && b == d) || (a == d && b == c)) return true;
    if (b == c) return folds_back(at(a), at(b), at(d));
    if (a == d) return folds_back(at(b), at(a), at(c));
    if (a == c) return folds_back(at(b), at(a), at(d));
    if (b == d) return folds_back(at(a), at(b), at(c));
    return segments_meet(at(a), at(b), at(c), at(d));
}

/// Calls meet(i, j) for the numbers of each pair of edges that meet, until it returns false or `tests` pairs were
/// looked at. A sweep along the longer side of the bounding box: O(n log n) plus the pairs whose extents overlap.
template <class Meet>
void for_each_meeting(std::span<const std::array<index, 2>> edges, std::span<const vec2> x, Meet&& meet,
                      std::size_t tests = std::numeric_limits<std::size_t>::max())
{
    struct extent
    {
        std::size_t edge;
        vec2 low, high;
    };
    if (edges.empty()) return;
    std::vector<extent> extents;
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
        const vec2 &p = x[static_cast<std::size_t>(edges[i][0])], &q = x[static_cast<std::size_t>(edges[i][1])];
        extents.push_back({i, glm::min(p, q), glm::max(p, q)});
    }
    vec2 low = extents.front().low;
    vec2 high = extents.front().high;
    for (const auto& e : extents)
    {
        low = glm::min(low, e.low);
        high = glm::max(high, e.high);
    }
    const int s = high.x - low.x >= high.y - low.y ? 0 : 1; // the sweep goes along s
    const int t = 1 - s;
    std::sort(extents.begin(), extents.end(), [s](const extent& e, const extent& f) { return e.low[s] < f.low[s]; });

    std::vector<const extent*> active; // edges whose extent along s may still reach the sweep line
    for (const auto& e : extents)
    {
        std::size_t kept = 0;
        for (const extent* f : active)
        {
            if (f->high[s] < e.low[s]) continue;
            active[kept++] = f;
            if (tests-- == 0) return;
            if (f->low[t] > e.high[t] || e.low[t] > f->high[t]) continue;
            if (edges_meet(edges[e.edge], edges[f->edge], x) && !meet(f->edge, e.edge)) return;
        }
        active.resize(kept);
        active.push_back(&e);
    }
}

} // namespace detail

/// Number of pairs of boundary edges whose images have a common point beyond a common end vertex: crossings, touchings
/// and overlaps. Exact. 0 together with a clean certificate means that a disk's map is injective.
///
/// loops: boundary loops as vertex indices, each of at least two; x: #V image points, finite.
inline std::size_t boundary_crossings(std::span<const std::vector<index>> loops, std::span<const vec2> x)
{
    std::vector<std::array<index, 2>> edges;
    for (const auto& loop : loops)
        for (std::size_t k = 0; k < loop.size(); ++k) edges.push_back({loop[k], loop[(k + 1) % loop.size()]});
    std::size_t count = 0;
    detail::for_each_meeting(edges, x,
                             [&count](std::size_t, std::size_t)
                             {
                                 ++count;
                                 return true;
                             });
    return count;
}

} // namespace taut
