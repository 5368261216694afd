// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/charts/paste/geodesic_distances.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <queue>
#include <utility>

namespace taut::impl
{

/// The distance of c from a source at the distances da of a and db of b: that of the source unfolded into the plane of
/// the triangle, where the line from it passes between a and b; else along an edge.
inline double distance_across(const vec3& a, const vec3& b, const vec3& c, double da, double db)
{
    const double along = std::min(da + glm::distance(a, c), db + glm::distance(b, c));
    const double length = glm::distance(a, b);
    if (!(length > 0)) return along;
    const vec3 axis = (b - a) / length;
    const double x = glm::dot(c - a, axis), y = glm::length(c - a - x * axis);
    const double sx = (da * da - db * db + length * length) / (2 * length);
    const double sy = -std::sqrt(std::max(0.0, da * da - sx * sx));
    if (!(y - sy > 0)) return along;
    const double crossing = sx + (x - sx) * -sy / (y - sy);
    return crossing >= 0 && crossing <= length ? std::min(along, std::hypot(x - sx, y - sy)) : along;
}

std::vector<double> geodesic_distances(const mesh<triangle>& m, const impl::csr& cells_of, std::span<const idx> from,
                                       double limit)
{
    constexpr double far = std::numeric_limits<double>::infinity();
    std::vector<double> distance(m.points().size(), far);
    std::vector<char> settled(m.points().size(), 0);
    using entry = std::pair<double, idx>;
    std::priority_queue<entry, std::vector<entry>, std::greater<>> front;
    const auto at = [](idx v) { return static_cast<std::size_t>(v); };
    for (const idx v : from) front.emplace(distance[at(v)] = 0, v);
    while (!front.empty())
    {
        const auto [d, v] = front.top();
        front.pop();
        if (settled[at(v)]) continue;
        settled[at(v)] = 1;
        for (const idx c : cells_of.row(v))
        {
            const auto& t = m.cells()[at(c)];
            for (std::size_t k = 0; k < 3; ++k)
            {
                const idx w = t[k];
                if (settled[at(w)]) continue;
                const idx u = t[(k + 1) % 3] == v ? t[(k + 2) % 3] : t[(k + 1) % 3]; // the third one
                const vec3 &x = m.points()[at(v)], &y = m.points()[at(w)];
                double reached = d + glm::distance(x, y);
                if (distance[at(u)] < far)
                    reached = std::min(reached, impl::distance_across(x, m.points()[at(u)], y, d, distance[at(u)]));
                if (reached <= limit && reached < distance[at(w)]) front.emplace(distance[at(w)] = reached, w);
            }
        }
    }
    return distance;
}

} // namespace taut::impl
