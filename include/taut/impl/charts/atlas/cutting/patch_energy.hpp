// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <taut/impl/charts/atlas/chart_start.hpp>
#include <taut/impl/charts/atlas/cutting/flat_surface.hpp>
#include <taut/impl/charts/atlas/surface_part.hpp>

namespace taut::impl
{

/// Maps what seams leave of a surface, if it is in one piece that is not closed: unfolded where that is less distorted
/// than the map that it has, or, without one, by a barycentric map. Returns whether there is a map.
inline bool start_flat(const rest_surface& rest, flat_surface& flat)
{
    const cut_surface cut = cut_surface::of(rest, flat);
    const mesh<triangle> m(cut.points, cut.cells);
    try
    {
        const ideal_elements<triangle> ideal(m);
        chart_start start{.uv = {}, .energy = flat.energy};
        if (flat.uv.empty())
            start.consider_laid(m, ideal);
        else
            start.consider(m, ideal, unfolded(m, facets(m)));
        if (start.uv.empty()) return !flat.uv.empty();
        flat.energy = start.energy;
        flat.uv.resize(flat.fan.size());
        for (std::size_t corner = 0; corner < flat.fan.size(); ++corner)
            flat.uv[corner] = start.uv[rest_surface::u(cut.cells[corner / 3][corner % 3])];
    }
    catch (const error&)
    {
        return !flat.uv.empty();
    }
    return true;
}

/// Mean energy of patches of so many triangles, each mapped by itself: some, spread evenly over the triangles of the
/// surface. What distorts these is noise, which no seams of a sensible length are below. 4 where no patch has a map.
inline double patch_energy(const mesh<triangle>& m, const facet_table& f, idx triangles)
{
    constexpr idx patches = 16;
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    std::vector<char> taken(m.cells().size(), 0), seam(f.twin.size(), 0);
    double sum = 0, area = 0;
    for (idx k = 0; k < patches; ++k)
    {
        std::vector<idx> own{static_cast<idx>((u(k) * m.cells().size()) / u(patches))};
        taken[u(own.front())] = 1;
        for (std::size_t i = 0; i < own.size() && own.size() < u(triangles); ++i)
            for (idx s = 3 * own[i]; s < 3 * own[i] + 3; ++s)
                if (const idx twin = f.twin[u(s)]; twin >= 0 && taken[u(twin / 3)] == 0)
                {
                    taken[u(twin / 3)] = 1;
                    own.push_back(twin / 3);
                }
        for (const idx c : own) taken[u(c)] = 0;
        std::sort(own.begin(), own.end());
        const surface_part part = part_of(m, own, seam);
        const rest_surface rest = rest_surface::of(part.charts.surface, part.charts.surface.cell_count());
        flat_surface flat;
        flat.seam.resize(rest.facets.twin.size(), 0);
        number_fans(rest, flat);
        if (!start_flat(rest, flat)) continue;
        relax(rest, flat, 60, 1e-4);
        if (!std::isfinite(flat.energy)) continue;
        sum += rest.total * flat.energy;
        area += rest.total;
    }
    return area > 0 ? sum / area : 4;
}

} // namespace taut::impl
