// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include <taut/impl/atlas/cutting/over_cut.hpp>

namespace taut::impl
{

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
