// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/cutting/curvature_potential.hpp>
#include <taut/impl/charts/atlas/cutting/flat_surface.hpp>

namespace taut::impl
{

/// The cheapest way along edges from any of some vertices to another one, as sides in either direction; empty where
/// there is none. price: one a side, not negative; from, blocked: one flag a vertex, no way leads through the latter
template <class Price>
std::vector<idx> edge_way(const rest_surface& rest, std::span<const char> from, idx to, const Price& price,
                          std::span<const char> blocked = {})
{
    const auto u = rest_surface::u;
    std::vector<double> distance(from.size(), std::numeric_limits<double>::infinity());
    std::vector<idx> came(from.size(), -1);
    using entry = std::pair<double, idx>;
    std::priority_queue<entry, std::vector<entry>, std::greater<>> queue;
    for (std::size_t v = 0; v < from.size(); ++v)
        if (from[v]) queue.emplace(distance[v] = 0, static_cast<idx>(v));
    const auto reach = [&](double here, idx side, idx w)
    {
        if (!blocked.empty() && blocked[u(w)] && w != to) return;
        const double there = here + price(side);
        if (!(there < distance[u(w)])) return;
        distance[u(w)] = there;
        came[u(w)] = side;
        queue.emplace(there, w);
    };
    while (!queue.empty())
    {
        const auto [here, v] = queue.top();
        queue.pop();
        if (here > distance[u(v)]) continue;
        if (v == to) break;
        for (const idx s : rest.sides.row(v))
        {
            reach(here, s, rest.end(s));
            const idx before = rest_surface::last(s);
            if (rest.twin(before) < 0) reach(here, before, rest.start(before));
        }
    }
    std::vector<idx> way;
    for (idx v = to; came[u(v)] >= 0;)
    {
        const idx s = came[u(v)];
        way.push_back(s);
        v = rest.start(s) == v ? rest.end(s) : rest.start(s);
    }
    std::reverse(way.begin(), way.end());
    return way;
}

/// One flag a vertex: 1 on seams and on the boundary.
inline std::vector<char> seam_vertices(const rest_surface& rest, std::span<const char> seam)
{
    std::vector<char> on = rest.rim;
    for (std::size_t s = 0; s < seam.size(); ++s)
        if (seam[s])
            on[rest_surface::u(rest.start(static_cast<idx>(s)))] = on[rest_surface::u(rest.end(static_cast<idx>(s)))] =
                1;
    return on;
}

/// Cuts a surface along ways to the extremes of the potential of its curvature, one after the other, until it is below
/// `stop` everywhere: more than what a map needs, so that seams can be sewn up from their tips.
class over_cutting
{
public:
    /// least: of a way's weight, where the potential is greatest; 1: plain lengths
    over_cutting(const rest_surface& rest, double least) : rest_(rest), potential_(rest), least_(least) {}

    /// Adds ways to a seam, `most` at most, while it is shorter than `longest`. Returns how many.
    int run(std::vector<char>& seam, double stop, int most, double longest = std::numeric_limits<double>::infinity())
    {
        const auto u = rest_surface::u;
        const auto greatest = [](std::span<const double> x)
        {
            const auto by_size = [](double a, double b) { return std::abs(a) < std::abs(b); };
            return static_cast<idx>(std::max_element(x.begin(), x.end(), by_size) - x.begin());
        };
        double length = seam_length(rest_, seam);
        for (int added = 0; added < most; ++added)
        {
            if (!(length < longest)) return added;
            auto on = seam_vertices(rest_, seam);
            const bool closed = std::find(on.begin(), on.end(), char(1)) == on.end();
            if (closed) on[u(first_tip())] = 1;
            const auto phi = potential_(on);
            const idx tip = greatest(phi);
            const double height = std::abs(phi[u(tip)]);
            if (!(height >= stop) && !closed) return added;
            const auto weight = [&](idx v) { return 1 / (least_ + (1 - least_) * std::abs(phi[u(v)]) / height); };
            const auto price = [&](idx s)
            { return rest_.price[u(s)] * 0.5 * (weight(rest_.start(s)) + weight(rest_.end(s))); };
            const auto way = edge_way(rest_, on, tip, price);
            if (way.empty()) return added;
            for (const idx s : way)
            {
                set_seam(rest_, seam, s, 1);
                length += rest_.length[u(s)];
            }
        }
        return most;
    }

private:
    /// Where a closed surface is cut first: an extreme of the potential with one vertex held.
    idx first_tip()
    {
        std::vector<char> one(rest_.surface.points().size(), 0);
        one[0] = 1;
        const auto phi = potential_(one);
        double mean = 0, area = 0;
        for (idx c = 0; c < rest_.triangles(); ++c)
            for (const idx v : rest_.surface.cells()[rest_surface::u(c)])
            {
                mean += rest_.area[rest_surface::u(c)] * phi[rest_surface::u(v)];
                area += rest_.area[rest_surface::u(c)];
            }
        mean /= area;
        std::size_t best = 0;
        for (std::size_t v = 0; v < phi.size(); ++v)
            if (std::abs(phi[v] - mean) > std::abs(phi[best] - mean)) best = v;
        return static_cast<idx>(best);
    }

    const rest_surface& rest_;
    curvature_potential potential_;
    double least_;
};

/// Cuts a surface along ways from its seams to the vertices inside that are distorted most, until all that do so have
/// `enough` of the mean energy above 4 around them. Each way prefers edges that are distorted, too. A surface without
/// vertices inside is flat: whatever the bound, repeated cuts reach it. The map is as before, its fans are not.
/// Returns the number of ways.
inline int cut_strained(const rest_surface& rest, flat_surface& flat, double enough)
{
    const auto u = rest_surface::u;
    std::vector<double> strain(rest.surface.points().size(), 0), around(strain.size(), 0);
    for (idx c = 0; c < rest.triangles(); ++c)
    {
        const double excess = std::max(0.0, energy_of(rest, flat.uv, c) - 4 * rest.weight[u(c)]);
        for (const idx v : rest.surface.cells()[u(c)])
        {
            strain[u(v)] += excess / 3;
            around[u(v)] += rest.weight[u(c)] / 3;
        }
    }
    auto on = seam_vertices(rest, flat.seam);
    int made = 0;
    double found = 0;
    while (found < enough * rest.total)
    {
        idx worst = -1;
        for (idx v = 0; v < rest.vertices(); ++v)
            if (!on[u(v)] && (worst < 0 || strain[u(v)] > strain[u(worst)])) worst = v;
        if (worst < 0 || !(strain[u(worst)] > 0)) break;
        const double most = strain[u(worst)] / around[u(worst)];
        const auto weight = [&](idx v)
        { return 1 / (0.3 + 0.7 * std::min(1.0, strain[u(v)] / (most * std::max(around[u(v)], 1e-300)))); };
        const auto price = [&](idx s)
        { return rest.price[u(s)] * 0.5 * (weight(rest.start(s)) + weight(rest.end(s))); };
        const auto way = edge_way(rest, on, worst, price);
        if (way.empty()) break;
        for (const idx s : way)
        {
            set_seam(rest, flat.seam, s, 1);
            for (const idx v : {rest.start(s), rest.end(s)})
                if (!on[u(v)])
                {
                    on[u(v)] = 1;
                    found += strain[u(v)];
                }
        }
        ++made;
    }
    return made;
}

} // namespace taut::impl
