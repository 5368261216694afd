// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/core/sparse/barycentric_system.hpp>
#include <taut/impl/core/start/barycentric_params.hpp>
#include <taut/start_map.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// tan(angle / 2) at p between directions to q and r, without cancellation for angles near 0 and near pi.
inline double tan_half_angle(const vec3& p, const vec3& q, const vec3& r)
{
    const vec3 a = q - p;
    const vec3 b = r - p;
    const double product = glm::length(a) * glm::length(b);
    const double sine = glm::length(glm::cross(a, b));
    const double cosine = glm::dot(a, b);
    return cosine >= 0 ? sine / (product + cosine) : (product - cosine) / sine;
}

/// Assembles the system of a surface whose vertices with fixed[v] != 0 stay at x[v].
///
/// points: #V rest positions; cells: #F triangles; fixed: #V; x: #V, read where fixed; pull: #V positive factors of the
/// weights towards each vertex, or empty.
/// A vertex whose weights are not all positive and finite has uniform ones: a triangle there is degenerate.
inline barycentric_system make_barycentric_system(std::span<const vec3> points,
                                                  std::span<const std::array<idx, 3>> cells,
                                                  std::span<const char> fixed, std::span<const vec2> x,
                                                  barycentric_weights weights, std::span<const double> pull = {})
{
    const auto u = [](idx v) { return static_cast<std::size_t>(v); };
    struct entry
    {
        idx to;
        double weight;
    };
    // Every corner at a free vertex sends two weights; rows are gathered by counting, then merged.
    std::vector<std::size_t> start(points.size() + 1, 0);
    for (const auto& cell : cells)
        for (const idx v : cell)
            if (!fixed[u(v)]) start[u(v) + 1] += 2;
    for (std::size_t v = 0; v < points.size(); ++v) start[v + 1] += start[v];
    std::vector<entry> entries(start.back());
    auto fill = start;
    for (const auto& cell : cells)
        for (std::size_t c = 0; c < 3; ++c)
        {
            const idx v = cell[c];
            if (fixed[u(v)]) continue;
            const idx q = cell[(c + 1) % 3];
            const idx r = cell[(c + 2) % 3];
            double wq = 0.5; // each edge of a closed fan is seen from both sides
            double wr = 0.5;
            if (weights == barycentric_weights::mean_value)
            {
                const double t = impl::tan_half_angle(points[u(v)], points[u(q)], points[u(r)]);
                wq = t / glm::length(points[u(q)] - points[u(v)]);
                wr = t / glm::length(points[u(r)] - points[u(v)]);
            }
            if (!pull.empty())
            {
                wq *= pull[u(q)];
                wr *= pull[u(r)];
            }
            entries[fill[u(v)]++] = {q, wq};
            entries[fill[u(v)]++] = {r, wr};
        }

    barycentric_system system;
    std::vector<idx> row_of(points.size(), -1);
    for (std::size_t v = 0; v < points.size(); ++v)
    {
        if (fixed[v] || start[v] == start[v + 1]) continue;
        row_of[v] = static_cast<idx>(system.unknown.size());
        system.unknown.push_back(static_cast<idx>(v));
    }
    system.excess.reserve(system.unknown.size());
    for (const idx v : system.unknown)
    {
        const std::span row(entries.data() + start[u(v)], entries.data() + start[u(v) + 1]);
        std::sort(row.begin(), row.end(), [](const entry& a, const entry& b) { return a.to < b.to; });
        std::size_t neighbours = 0;
        bool valid = true;
        for (std::size_t k = 0; k < row.size(); ++neighbours)
        {
            entry sum{row[k].to, 0};
            for (; k < row.size() && row[k].to == sum.to; ++k) sum.weight += row[k].weight;
            valid = valid && sum.weight > 0 && std::isfinite(sum.weight);
            row[neighbours] = sum;
        }
        double excess = 0;
        vec2 rhs(0);
        for (const auto& [to, weight] : row.first(neighbours))
        {
            const double w = valid ? weight : 1;
            if (fixed[u(to)])
            {
                excess += w;
                rhs += w * x[u(to)];
            }
            else
            {
                system.column.push_back(row_of[u(to)]);
                system.weight.push_back(w);
            }
        }
        system.excess.push_back(excess);
        system.rhs.push_back(rhs);
        system.offset.push_back(static_cast<idx>(system.column.size()));
    }
    return system;
}

} // namespace taut::impl
