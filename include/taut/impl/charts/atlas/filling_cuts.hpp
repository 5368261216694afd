// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/cutting/minimum_cut.hpp>
#include <taut/impl/charts/atlas/cutting/way_prices.hpp>
#include <taut/impl/charts/atlas/surface_part.hpp>

namespace taut::impl
{

/// Short cuts across the waists and the limbs of a chart: long charts and those with limbs fill a square better so.
class waist_cutting
{
public:
    /// A cut: sides of the surface, of one triangle of each edge, what they count, and triangles of the surface on one
    /// side of them.
    struct cut
    {
        std::vector<std::size_t> sides;
        double price = 0;
        std::vector<idx> beyond;
    };

    /// triangles: of the chart, ascending; seam, price: one a side of the surface
    waist_cutting(const mesh<triangle>& m, std::span<const idx> triangles, std::span<const char> seam,
                  std::span<const double> price)
        : part_(part_of(m, triangles, seam)),
          rest_(rest_surface::of(part_.charts.surface, part_.charts.surface.cell_count()))
    {
        for (std::size_t s = 0; s < rest_.price.size(); ++s) rest_.price[s] = price[part_.origin(s)];
    }

    /// The cheapest cuts between parts of the area, from one end of the chart to the other, and around its tips.
    std::vector<cut> cuts() const
    {
        constexpr std::array<std::array<double, 2>, 5> across{
            {{0.4, 0.6}, {0.2, 0.45}, {0.55, 0.8}, {0.08, 0.2}, {0.8, 0.92}}};
        constexpr std::array<std::array<double, 2>, 2> around{{{0.02, 0.12}, {0.06, 0.3}}};
        constexpr std::size_t tips = 5;
        std::vector<cut> result;
        std::vector<double> nearest = distances(farthest(distances(0)));
        add_cuts(nearest, across, result);
        for (std::size_t k = 1; k < tips; ++k) // each the farthest from those before
        {
            const auto from = distances(farthest(nearest));
            add_cuts(from, around, result);
            for (std::size_t c = 0; c < nearest.size(); ++c) nearest[c] = std::min(nearest[c], from[c]);
        }
        return result;
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// Adds the cheapest cuts between what is near and what is far, in parts of the area.
    void add_cuts(std::span<const double> distance, std::span<const std::array<double, 2>> between,
                  std::vector<cut>& result) const
    {
        std::vector<idx> order(distance.size());
        std::iota(order.begin(), order.end(), idx(0));
        std::stable_sort(order.begin(), order.end(), [&](idx a, idx b) { return distance[u(a)] < distance[u(b)]; });
        for (const auto& [low, high] : between)
        {
            std::vector<idx> begin, end;
            double area = 0;
            for (const idx c : order)
            {
                area += rest_.area[u(c)];
                if (area < low * rest_.total) begin.push_back(c);
                if (area > high * rest_.total) end.push_back(c);
            }
            if (begin.empty() || end.empty()) continue;
            cut one;
            std::vector<char> seam(rest_.price.size(), 0);
            for (const idx s : minimum_cutting(rest_).run(seam, begin, end))
            {
                seam[u(s)] = seam[u(rest_.twin(s))] = 1;
                one.sides.push_back(part_.origin(u(s)));
                one.price += rest_.price[u(s)];
            }
            if (one.sides.empty()) continue;
            one.beyond = reached(std::move(begin), seam);
            result.push_back(std::move(one));
        }
    }

    /// Triangles of the surface that are reached from these without crossing a seam.
    std::vector<idx> reached(std::vector<idx> front, std::span<const char> seam) const
    {
        std::vector<char> seen(rest_.surface.cells().size(), 0);
        for (const idx c : front) seen[u(c)] = 1;
        std::vector<idx> all;
        while (!front.empty())
        {
            const idx c = front.back();
            front.pop_back();
            all.push_back(part_.triangles[u(c)]);
            for (idx s = 3 * c; s < 3 * c + 3; ++s)
                if (rest_.twin(s) >= 0 && !seam[u(s)] && !std::exchange(seen[u(rest_.twin(s) / 3)], 1))
                    front.push_back(rest_.twin(s) / 3);
        }
        return all;
    }

    /// From a triangle to all others, between the middles of neighbours.
    std::vector<double> distances(idx from) const
    {
        std::vector<double> distance(rest_.surface.cells().size(), std::numeric_limits<double>::infinity());
        const auto middle = [&](idx c)
        {
            const auto x = rest_.surface.rest(c);
            return (x[0] + x[1] + x[2]) / 3.0;
        };
        using entry = std::pair<double, idx>;
        std::priority_queue<entry, std::vector<entry>, std::greater<>> queue;
        queue.emplace(distance[u(from)] = 0, from);
        while (!queue.empty())
        {
            const auto [here, c] = queue.top();
            queue.pop();
            if (here > distance[u(c)]) continue;
            for (idx s = 3 * c; s < 3 * c + 3; ++s)
            {
                if (rest_.twin(s) < 0) continue;
                const idx d = rest_.twin(s) / 3;
                if (const double there = here + glm::distance(middle(c), middle(d)); there < distance[u(d)])
                    queue.emplace(distance[u(d)] = there, d);
            }
        }
        return distance;
    }

    static idx farthest(std::span<const double> distance)
    {
        return static_cast<idx>(std::max_element(distance.begin(), distance.end()) - distance.begin());
    }

    surface_part part_;
    rest_surface rest_;
};

} // namespace taut::impl
