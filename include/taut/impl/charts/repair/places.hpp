// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <unordered_map>
#include <vector>

#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/impl/core/core/keyed_hash.hpp>

/// Welding of points: finds those at one place.
namespace taut::impl
{

/// A hash of a place in a body.
inline std::uint64_t hash_place(const vec3& p, idx body)
{
    const auto [x, y, z] = bits_of(p);
    return keyed_hash(std::array{x, y, z, static_cast<std::uint64_t>(body)});
}

/// The body that a point is of. bodies: one per point, or none
inline idx body_of(std::span<const idx> bodies, idx point)
{
    return bodies.empty() ? 0 : bodies[static_cast<std::size_t>(point)];
}

/// The smallest of the points `some` of the same body with the same coordinates, one per point; the point itself for
/// the others.
/// some: points with finite coordinates, increasing
inline std::vector<idx> equal_places(std::span<const vec3> points, std::span<const idx> bodies,
                                     std::span<const idx> some)
{
    const std::size_t n = some.size();
    const auto point = [&](idx i) { return points[static_cast<std::size_t>(i)]; };
    std::vector<idx> order(n), place(points.size());
    std::iota(place.begin(), place.end(), idx(0));
    const auto start = counting_sort(
        n, std::max<std::size_t>(n, 1),
        [&](std::size_t i) { return hash_place(point(some[i]), body_of(bodies, some[i])) % n; },
        [&](std::size_t i, std::size_t at) { order[at] = some[i]; });
    for (std::size_t bucket = 0; bucket + 1 < start.size(); ++bucket)
    {
        const auto first = order.begin() + start[bucket], last = order.begin() + start[bucket + 1];
        std::sort(first, last,
                  [&](idx i, idx j)
                  {
                      if (const idx a = body_of(bodies, i), b = body_of(bodies, j); a != b) return a < b;
                      const vec3 p = point(i), q = point(j);
                      for (int k = 0; k < 3; ++k)
                          if (p[k] != q[k]) return p[k] < q[k];
                      return i < j;
                  });
        for (auto i = first; i != last; ++i)
            if (i != first && point(*i) == point(i[-1]) && body_of(bodies, *i) == body_of(bodies, i[-1]))
                place[static_cast<std::size_t>(*i)] = place[static_cast<std::size_t>(i[-1])];
    }
    return place;
}

/// The same for points that may be apart: in their order, each of `some` joins the nearest before it that has joined
/// none, if they are no further from each other than the reach of both, so that nothing moves further. Those equal stay
/// together. Points whose reach is less than half of their distance to a third never meet there.
/// place: of equal_places()
/// some:  points with place[i] == i, increasing
/// reach: one per point; 0 or more, and at most `most`. What is below 1e-9 of that counts as 0
inline std::vector<idx> near_places(std::span<const vec3> points, std::span<const idx> bodies, std::vector<idx> place,
                                    std::span<const idx> some, std::span<const double> reach, double most)
{
    // Those of a grid are further from each other than half the size of its cells, which so hold a few.
    struct grid
    {
        double size = 0;
        std::unordered_multimap<std::uint64_t, idx> apart{};
        vec3 cell_of(const vec3& p) const { return glm::floor(p / size); }
    };
    std::array<grid, 30> grids;
    for (std::size_t g = 0; g < grids.size(); ++g) grids[g].size = std::ldexp(most, -static_cast<int>(g));
    for (const idx i : some)
    {
        const vec3 p = points[static_cast<std::size_t>(i)];
        const double r = std::min(reach[static_cast<std::size_t>(i)], most);
        std::size_t own = 0; // the grid whose cells are the smallest that are no smaller than r
        while (own + 1 < grids.size() && r <= grids[own + 1].size) ++own;
        const vec3 q = grids.back().cell_of(p);
        if (!(r > grids.back().size) || !std::isfinite(q.x) || !std::isfinite(q.y) || !std::isfinite(q.z)) continue;
        const idx body = body_of(bodies, i);
        double least = r;
        idx nearest = i;
        for (const grid& g : grids)
        {
            if (g.apart.empty()) continue;
            const vec3 cell = g.cell_of(p);
            for (int n = 0; n < 27; ++n)
            {
                const auto [from, to] =
                    g.apart.equal_range(hash_place(cell + vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1), body));
                for (auto k = from; k != to; ++k)
                {
                    if (body_of(bodies, k->second) != body) continue;
                    const vec3 away = points[static_cast<std::size_t>(k->second)] - p;
                    const double d = std::hypot(away.x, away.y, away.z);
                    if (d > reach[static_cast<std::size_t>(k->second)]) continue;
                    if (d < least || (d == least && (nearest == i || k->second < nearest)))
                    {
                        least = d;
                        nearest = k->second;
                    }
                }
            }
        }
        place[static_cast<std::size_t>(i)] = nearest;
        if (nearest == i) grids[own].apart.emplace(hash_place(grids[own].cell_of(p), body), i);
    }
    for (idx& p : place) p = place[static_cast<std::size_t>(p)];
    return place;
}

} // namespace taut::impl
