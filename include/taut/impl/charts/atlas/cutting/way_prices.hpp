// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/cutting/rest_surface.hpp>
#include <taut/impl/core/core/parallel.hpp>

namespace taut::impl
{

/// What a seam along each side of a surface counts: its length, times a factor.
/// together: sides that are to be no seams, or empty; factors: one a side, or empty: 1
inline std::vector<double> side_prices(const mesh<triangle>& m, const facet_table& f, std::span<const char> together,
                                       std::span<const double> factors)
{
    constexpr double unwanted = 1000; // where a seam is not to be, its length counts so often
    std::vector<double> price(f.twin.size());
    for (std::size_t s = 0; s < price.size(); ++s)
    {
        const auto& t = m.cells()[s / 3];
        const auto at = [&](std::size_t k) { return m.points()[static_cast<std::size_t>(t[(s + k) % 3])]; };
        price[s] = glm::distance(at(1), at(2));
        if (!factors.empty()) price[s] *= factors[s];
        if (!together.empty() && together[s]) price[s] *= unwanted;
    }
    return price;
}

/// What a seam along each side of a coarse surface counts: the cheapest way on the surface that it was made of, between
/// the vertices of the side. Sides without such vertices, in holes, count their length.
/// sides, price: starting_sides() and one a side of the fine surface m; origins: the vertex there of coarse ones
inline std::vector<double> way_prices(const mesh<triangle>& m, const facet_table& f, const csr& sides,
                                      std::span<const double> price, const rest_surface& coarse,
                                      std::span<const idx> origins)
{
    const auto u = rest_surface::u;
    const auto vertex = [&](idx side, idx turn) { return m.cells()[u(side / 3)][u((side % 3 + turn) % 3)]; };
    std::vector<double> result = coarse.length;
    const auto n = static_cast<idx>(origins.size());
    parallel_for(
        result.size(),
        [&](std::size_t begin, std::size_t end)
        {
            std::vector<double> distance(m.points().size(), std::numeric_limits<double>::infinity());
            std::vector<idx> touched;
            for (std::size_t k = begin; k < end; ++k)
            {
                const auto side = static_cast<idx>(k);
                const idx a = coarse.start(side), b = coarse.end(side), twin = coarse.twin(side);
                if (a >= n || b >= n || (twin >= 0 && twin < side)) continue;
                const idx from = origins[u(a)], to = origins[u(b)];
                using entry = std::pair<double, idx>;
                std::priority_queue<entry, std::vector<entry>, std::greater<>> queue;
                const auto reach = [&](double there, idx w)
                {
                    if (!(there < distance[u(w)])) return;
                    if (distance[u(w)] == std::numeric_limits<double>::infinity()) touched.push_back(w);
                    distance[u(w)] = there;
                    queue.emplace(there, w);
                };
                reach(0, from);
                while (!queue.empty() && queue.top().second != to)
                {
                    const auto [here, v] = queue.top();
                    queue.pop();
                    if (here > distance[u(v)]) continue;
                    for (const idx s : sides.row(v))
                    {
                        reach(here + price[u(s)], vertex(s, 2));
                        const idx before = rest_surface::last(s);
                        if (f.twin[u(before)] < 0) reach(here + price[u(before)], vertex(before, 1));
                    }
                }
                if (!queue.empty()) result[k] = distance[u(to)];
                for (const idx v : touched) distance[u(v)] = std::numeric_limits<double>::infinity();
                touched.clear();
            }
        },
        0, 256);
    for (std::size_t k = 0; k < result.size(); ++k)
        if (const idx twin = coarse.twin(static_cast<idx>(k)); twin >= 0 && u(twin) < k) result[k] = result[u(twin)];
    return result;
}

} // namespace taut::impl
