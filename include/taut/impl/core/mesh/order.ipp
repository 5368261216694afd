// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/mesh/order.hpp>

namespace taut::impl
{

std::vector<idx> along_curve(const std::vector<vec3>& points)
{
    vec3 low = points[0], high = points[0];
    for (const vec3& p : points)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    // Halves, because the extent of finite points may overflow.
    const vec3 half = 0.5 * high - 0.5 * low;
    const double extent = std::max({half.x, half.y, half.z});
    using key = std::pair<std::uint64_t, idx>;
    std::vector<key> keys(points.size()), sorted(points.size());
    parallel_for(points.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t v = begin; v < end; ++v)
                     {
                         const vec3 unit = extent > 0 ? (0.5 * points[v] - 0.5 * low) / extent : vec3(0.0);
                         keys[v] = {morton(2097151.0 * unit), static_cast<idx>(v)};
                     }
                 });

    // Buckets by the first digits, octants of space, and each sorted for itself.
    constexpr int digits = 15;
    const auto start = counting_sort(
        keys.size(), std::size_t{1} << digits, [&](std::size_t i) { return keys[i].first >> (63 - digits); },
        [&](std::size_t i, std::size_t position) { sorted[position] = keys[i]; });
    std::vector<idx> order(points.size());
    parallel_for(
        start.size() - 1,
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t b = begin; b < end; ++b)
                std::sort(sorted.begin() + start[b], sorted.begin() + start[b + 1]);
            for (auto i = static_cast<std::size_t>(start[begin]); i < static_cast<std::size_t>(start[end]); ++i)
                order[i] = sorted[i].second;
        },
        0, points.size() < 8192 ? start.size() : 4096);
    return order;
}

template mesh_order locality_order(const mesh<triangle>&);
template solution_order::solution_order(const mesh<triangle>&, const std::vector<bool>&);
template mesh<triangle> permute(const mesh<triangle>&, const mesh_order&);
template mesh_order locality_order(const mesh<tetrahedron>&);
template solution_order::solution_order(const mesh<tetrahedron>&, const std::vector<bool>&);
template mesh<tetrahedron> permute(const mesh<tetrahedron>&, const mesh_order&);

} // namespace taut::impl
