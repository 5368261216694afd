// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/atlas/cutting/minimum_cut.hpp>
#include <taut/impl/atlas/cutting/way_prices.hpp>
#include <taut/impl/atlas/surface_part.hpp>

namespace taut::impl
{

/// Short cuts across the waists of a chart, which part it into two of much the same area: long charts fill a square
/// better so.
class waist_cutting
{
public:
    /// A cut: sides of the surface, of one triangle of each edge, and what they count.
    struct cut
    {
        std::vector<std::size_t> sides;
        double price = 0;
    };

    /// triangles: of the chart, ascending; seam, price: one a side of the surface
    waist_cutting(const mesh<triangle>& m, std::span<const idx> triangles, std::span<const char> seam,
                  std::span<const double> price)
        : part_(made_part(m, triangles, seam)),
          rest_(rest_surface::of(part_.charts.surface, part_.charts.surface.cell_count()))
    {
        for (std::size_t s = 0; s < rest_.price.size(); ++s) rest_.price[s] = price[part_.origin(s)];
        along_ = distances(farthest(distances(0)));
    }

    /// The cheapest cuts between parts of the area, from one end of the chart to the other.
    std::vector<cut> cuts() const
    {
        constexpr std::array<std::array<double, 2>, 5> between{
            {{0.4, 0.6}, {0.2, 0.45}, {0.55, 0.8}, {0.08, 0.2}, {0.8, 0.92}}};
        std::vector<idx> order(along_.size());
        std::iota(order.begin(), order.end(), idx(0));
        std::stable_sort(order.begin(), order.end(), [&](idx a, idx b) { return along_[u(a)] < along_[u(b)]; });
        std::vector<cut> result;
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
            for (const idx s : minimum_cut(rest_, std::vector<char>(rest_.price.size(), 0), begin, end))
            {
                one.sides.push_back(part_.origin(u(s)));
                one.price += rest_.price[u(s)];
            }
            if (!one.sides.empty()) result.push_back(std::move(one));
        }
        return result;
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    static surface_part made_part(const mesh<triangle>& m, std::span<const idx> triangles, std::span<const char> seam)
    {
        std::vector<idx> number(m.points().size(), -1);
        return part_of(m, triangles, seam, number);
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
    std::vector<double> along_; // one a triangle: from one end of the chart
};

} // namespace taut::impl
