// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/cutting/give_crumbs.hpp>
#include <taut/impl/charts/atlas/cutting/minimum_cut.hpp>
#include <taut/impl/charts/atlas/cutting/overlap_layers.hpp>

namespace taut::impl
{

/// When a chart that lies on itself is parted.
struct parting
{
    double least_area = 0.015; ///< of a layer, by the whole; what is less is kept apart as it is mapped
    double longest = 0.4;      ///< of a cut, by the root of the area
    double worth = 0;          ///< of an overlap, as a length by area: longer cuts than that and `longest` are not made
    int most = 40;             ///< cuts
    bool at_once = false;      ///< all overlaps of a map are parted before it follows
};

/// Parts charts of which large layers lie on each other, by the shortest cuts between these, largest first. The map
/// follows each cut. Returns how many were made.
inline int part_charts(const rest_surface& rest, flat_surface& flat, const parting& how)
{
    const auto u = rest_surface::u;
    minimum_cutting between(rest);
    std::vector<std::pair<idx, idx>> left_alone; // layers, by a triangle of each
    int made = 0;
    while (made < how.most)
    {
        bool parted = false;
        for (const overlap_layers& one : find_overlaps(rest, flat))
        {
            if (!(one.area > how.least_area * rest.total)) break;
            const bool known = std::any_of(left_alone.begin(), left_alone.end(),
                                           [&](const std::pair<idx, idx>& p)
                                           {
                                               const auto has = [](const std::vector<idx>& v, idx c)
                                               { return std::binary_search(v.begin(), v.end(), c); };
                                               return (has(one.below, p.first) && has(one.above, p.second)) ||
                                                      (has(one.below, p.second) && has(one.above, p.first));
                                           });
            if (known) continue;
            const auto cut = between.run(flat.seam, one.below, one.above);
            double length = 0;
            for (const idx s : cut) length += rest.price[u(s)];
            if (cut.empty()) continue; // parted by another cut
            if (!(length <= std::max(how.longest * std::sqrt(rest.total), how.worth * one.area)))
            {
                left_alone.emplace_back(one.below.front(), one.above.front());
                continue;
            }
            for (const idx s : cut) set_seam(rest, flat.seam, s, 1);
            ++made;
            parted = true;
            if (!how.at_once || made == how.most) break;
        }
        if (!parted) break;
        number_fans(rest, flat);
        relax(rest, flat, 3, 1e-4);
    }
    return made;
}

/// Parts charts where they lie on themselves by the shortest cuts between the layers, largest first, and then between
/// triangles whose borders still meet, as layers that are thinner than rounding are not told. The maps stay, so that it
/// ends after few cuts a layer, whatever the surface. Returns the number of cuts.
inline int cut_layers(const rest_surface& rest, flat_surface& flat)
{
    constexpr int rounds = 8, most = 400; // cuts
    minimum_cutting between(rest);
    auto chart = pieces_between(rest.facets, flat.seam).first;
    auto pairs = overlapping_pairs(rest, flat.uv, chart);
    int made = 0;
    const auto part = [&](std::span<const idx> below, std::span<const idx> above)
    {
        if (below.empty() || above.empty() || made == most) return;
        const auto cut = between.run(flat.seam, below, above); // empty: parted by another one
        for (const idx s : cut) set_seam(rest, flat.seam, s, 1);
        made += !cut.empty();
    };
    for (int round = 0, before = -1; round < rounds && made < most && made != before; ++round)
    {
        before = made;
        if (round > 0) chart = pieces_between(rest.facets, flat.seam).first;
        std::erase_if(pairs, [&](const triangle_pair& p)
                      { return chart[rest_surface::u(p[0])] != chart[rest_surface::u(p[1])]; });
        for (const overlap_layers& one : layers_of(rest, flat, pairs)) part(one.below, one.above);
        if (made != before) continue;
        number_fans(rest, flat);
        std::vector<std::array<idx, 2>> meeting; // triangles
        for_each_border_crossing(rest, flat,
                                 [&](idx s, idx t)
                                 {
                                     meeting.push_back({s / 3, t / 3});
                                     return std::ssize(meeting) < most;
                                 });
        for (const auto& [a, b] : meeting)
            if (a != b) part({&a, 1}, {&b, 1});
    }
    return made;
}

/// How charts that lie on themselves are parted as they are.
struct laid_parting
{
    std::span<const double> price;           ///< what a seam counts, one a side of the surface
    std::span<const char> seams;             ///< sides that stay seams, or empty
    bool give = true;                        ///< what is small to neighbours
    double bound = crumb_giving::bad_energy; ///< of the mean energy of a chart that is given to its neighbour
};

/// Parts charts where they lie on themselves; what is small then goes to neighbours beside which there is room, and
/// where these lie on themselves they are parted again. Returns whether something has changed.
inline bool part_laid(const mesh<triangle>& m, const laid_seams& laid, const laid_parting& how)
{
    laid_part own = laid_part::of(m, laid, how.seams, {});
    for (std::size_t s = 0; s < own.rest.price.size(); ++s) own.rest.price[s] = how.price[own.part.origin(s)];
    if (cut_layers(own.rest, own.flat) == 0) return false;
    const auto charts = [&] { return pieces_between(own.rest.facets, own.flat.seam).second; };
    constexpr int turns = 3;
    for (int turn = 0; how.give && turn < turns; ++turn)
    {
        auto tried = own.flat;
        if (crumb_giving(own.rest, tried, how.bound).run() == 0) break;
        cut_layers(own.rest, tried);
        if (!(pieces_between(own.rest.facets, tried.seam).second < charts())) break;
        own.flat = std::move(tried);
    }
    own.write(laid);
    return true;
}

} // namespace taut::impl
