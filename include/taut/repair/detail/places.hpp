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

#include <taut/core/counting_sort.hpp>
#include <taut/core/keyed_hash.hpp>

/// Which points are at one place.
namespace taut::detail
{

/// A hash of a place in a body.
inline std::uint64_t hash_place(const vec3& p, idx body)
{
    const auto [x, y, z] = bits_of(p);
    return keyed_hash(std::array{x, y, z, static_cast<std::uint64_t>(body)});
}

/// The body that a point is of. bodies: one a point, or none
inline idx body_of(std::span<const idx> bodies, idx point)
{
    return bodies.empty() ? 0 : bodies[static_cast<std::size_t>(point)];
}

/// The smallest of the points `some` of the same body with the same coordinates, one a point; the point itself for the
/// others.
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

/// The same for points that may be `tolerance` apart: in their order, each of `some` joins the nearest before it that
/// has joined none, so that nothing moves further. Those equal stay together.
/// place: of equal_places()
/// some:  points with place[i] == i, increasing
inline std::vector<idx> near_places(std::span<const vec3> points, std::span<const idx> bodies, std::vector<idx> place,
                                    std::span<const idx> some, double tolerance)
{
    const auto cell_of = [&](const vec3& p) { return glm::floor(p / tolerance); };
    std::unordered_multimap<std::uint64_t, idx> apart; // by cells of the size of the tolerance
    for (const idx i : some)
    {
        const vec3 p = points[static_cast<std::size_t>(i)], cell = cell_of(p);
        const idx body = body_of(bodies, i);
        double least = tolerance;
        idx nearest = i;
        for (int n = 0; n < 27; ++n)
        {
            const auto [from, to] =
                apart.equal_range(hash_place(cell + vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1), body));
            for (auto k = from; k != to; ++k)
            {
                if (body_of(bodies, k->second) != body) continue;
                const double d = glm::length(points[static_cast<std::size_t>(k->second)] - p);
                if (d < least || (d == least && k->second < nearest))
                {
                    least = d;
                    nearest = k->second;
                }
            }
        }
        place[static_cast<std::size_t>(i)] = nearest;
        if (nearest == i) apart.emplace(hash_place(cell, body), i);
    }
    for (idx& p : place) p = place[static_cast<std::size_t>(p)];
    return place;
}

} // namespace taut::detail
