// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/hierarchy/affine_weights.hpp>
#include <taut/impl/core/hierarchy/prolongation.hpp>

namespace taut::impl
{

/// Volume under coarsening: points and their neighbours. Cells are not needed, so any shape can be coarsened.
struct point_cloud
{
    std::vector<vec3> points;
    csr neighbours;         ///< symmetric; none of a vertex without cells
    std::vector<char> rank; ///< boundary_rank(): large ones stay first, or corners and creases would be cut off
    std::vector<char> held; ///< does not move
};

/// Computes a maximal independent set of vertices: those of greater rank first, then by number. Ascending; without the
/// vertices that have no neighbours.
inline std::vector<idx> maximal_independent_set(const point_cloud& cloud)
{
    const std::size_t n = cloud.points.size();
    enum state : char
    {
        undecided,
        out,
        in
    };
    std::vector<char> states(n, undecided);
    for (char rank = 3; rank >= 0; --rank)
        for (std::size_t v = 0; v < n; ++v)
        {
            const auto around = cloud.neighbours.row(static_cast<idx>(v));
            if (cloud.rank[v] != rank || states[v] != undecided || around.empty()) continue;
            states[v] = in;
            for (const idx w : around) states[static_cast<std::size_t>(w)] = out;
        }
    std::vector<idx> chosen;
    for (std::size_t v = 0; v < n; ++v)
        if (states[v] == in) chosen.push_back(static_cast<idx>(v));
    return chosen;
}

/// Interpolation from the chosen points to all: each from chosen ones at most two edges away. Linear functions are
/// reproduced but near the boundary, where the row is affine_search's best. Rows of fixed vertices are 0.
inline prolongation<4> interpolate(const point_cloud& cloud, std::span<const idx> chosen, unsigned threads)
{
    const std::size_t n = cloud.points.size();
    std::vector<idx> number(n, -1);
    for (std::size_t c = 0; c < chosen.size(); ++c) number[static_cast<std::size_t>(chosen[c])] = static_cast<idx>(c);
    prolongation<4> P;
    P.columns.assign(n, {});
    P.weights.assign(n, {});
    parallel_for(
        n,
        [&](std::size_t begin, std::size_t end)
        {
            std::vector<idx> seen(n, -1);
            std::vector<std::pair<double, idx>> near;
            for (std::size_t i = begin; i < end; ++i)
            {
                const auto v = static_cast<idx>(i);
                if (cloud.held[i] || cloud.neighbours.row(v).empty()) continue;
                if (number[i] >= 0)
                {
                    P.columns[i].fill(number[i]);
                    P.weights[i][0] = 1;
                    continue;
                }
                near.clear();
                seen[i] = v;
                const auto meet = [&](idx w)
                {
                    const auto at = static_cast<std::size_t>(w);
                    if (std::exchange(seen[at], v) == v || number[at] < 0) return;
                    const vec3 d = cloud.points[at] - cloud.points[i];
                    near.emplace_back(glm::dot(d, d), w);
                };
                for (const idx w : cloud.neighbours.row(v))
                {
                    meet(w);
                    for (const idx u : cloud.neighbours.row(w)) meet(u);
                }
                std::sort(near.begin(), near.end());
                std::array<vec3, affine_search::most_points> points;
                const std::size_t count = std::min(near.size(), points.size());
                for (std::size_t k = 0; k < count; ++k)
                    points[k] = cloud.points[static_cast<std::size_t>(near[k].second)] - cloud.points[i];
                const auto best = affine_search::best({points.data(), count});
                for (std::size_t k = 0; k < 4; ++k)
                    P.columns[i][k] = number[static_cast<std::size_t>(near[best.at[k]].second)];
                P.weights[i] = best.weights;
            }
        },
        threads, 4096);
    transpose(P, chosen.size(), threads);
    return P;
}

/// Cloud of the chosen points: neighbours are points that some vertex is interpolated from together.
inline point_cloud thinned(const point_cloud& cloud, std::span<const idx> chosen, const prolongation<4>& P,
                           unsigned threads)
{
    const std::size_t n = chosen.size();
    point_cloud coarse;
    for (const idx c : chosen)
    {
        const auto v = static_cast<std::size_t>(c);
        coarse.points.push_back(cloud.points[v]);
        coarse.rank.push_back(cloud.rank[v]);
        coarse.held.push_back(cloud.held[v]);
    }
    std::vector<std::vector<idx>> rows(n);
    parallel_for(
        n,
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t c = begin; c < end; ++c)
            {
                auto& row = rows[c];
                for (const idx place : P.transpose.row(static_cast<idx>(c)))
                {
                    const auto i = static_cast<std::size_t>(place / 4);
                    for (std::size_t k = 0; k < 4; ++k)
                        if (P.weights[i][k] != 0 && P.columns[i][k] != static_cast<idx>(c))
                            row.push_back(P.columns[i][k]);
                }
                std::sort(row.begin(), row.end());
                row.erase(std::unique(row.begin(), row.end()), row.end());
            }
        },
        threads, 1024);
    coarse.neighbours.offsets.push_back(0);
    for (const auto& row : rows)
    {
        coarse.neighbours.items.insert(coarse.neighbours.items.end(), row.begin(), row.end());
        coarse.neighbours.offsets.push_back(static_cast<idx>(coarse.neighbours.items.size()));
    }
    return coarse;
}

} // namespace taut::impl
