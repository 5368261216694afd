// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/atlas/chart_mesh.hpp>

namespace taut::impl
{

/// Some triangles of a surface as charts. Sides and corners are numbered 3 triangle + k in both.
struct surface_part
{
    chart_mesh charts;
    std::vector<idx> triangles; ///< triangles of the whole surface, one per triangle of the charts

    /// The side or corner of the whole surface.
    std::size_t origin(std::size_t side) const { return 3 * static_cast<std::size_t>(triangles[side / 3]) + side % 3; }
};

/// Cuts whole charts out of a surface.
/// triangles: all those of the charts, ascending; seam: one flag per side of the surface
/// number:    one per vertex of the surface, all -1, and so again afterwards
inline surface_part part_of(const mesh<triangle>& m, std::span<const idx> triangles, std::span<const char> seam,
                            std::vector<idx>& number)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    std::vector<char> part_seam;
    cells.reserve(triangles.size());
    part_seam.reserve(3 * triangles.size());
    for (const idx c : triangles)
    {
        auto t = m.cells()[u(c)];
        for (std::size_t k = 0; k < 3; ++k)
        {
            idx& n = number[u(t[k])];
            if (n < 0)
            {
                n = static_cast<idx>(points.size());
                points.push_back(m.points()[u(t[k])]);
            }
            t[k] = n;
            part_seam.push_back(seam[3 * u(c) + k]);
        }
        cells.push_back(t);
    }
    for (const idx c : triangles)
        for (const idx v : m.cells()[u(c)]) number[u(v)] = -1;

    const mesh<triangle> surface(std::move(points), std::move(cells));
    surface_part part{cut_charts(surface, facets(surface), part_seam), {}};
    for (const idx c : part.charts.cell_origins) part.triangles.push_back(triangles[u(c)]);
    return part;
}

} // namespace taut::impl
