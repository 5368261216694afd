// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>

namespace taut::impl
{

/// Some triangles of a surface as charts. Sides and corners are numbered 3 triangle + k in both.
struct surface_part
{
    chart_mesh charts;
    std::vector<idx> triangles; ///< triangles of the whole surface, one per triangle of the charts

    /// The side or corner of the whole surface.
    std::size_t origin(std::size_t side) const { return 3 * static_cast<std::size_t>(triangles[side / 3]) + side % 3; }

    /// The first triangle of a chart, as the surface numbers it.
    idx first_triangle(std::size_t chart) const
    {
        return triangles[static_cast<std::size_t>(charts.first_cell[chart])];
    }

    /// Values of sides or corners of the whole surface, or none, for those of the charts.
    template <class T>
    std::vector<T> by_side(std::span<const T> whole) const
    {
        std::vector<T> own(whole.empty() ? 0 : 3 * triangles.size());
        for (std::size_t s = 0; s < own.size(); ++s) own[s] = whole[origin(s)];
        return own;
    }

    /// Values of corners of the whole surface, the same around each vertex of the charts, for these vertices.
    template <class T>
    std::vector<T> by_vertex(const std::vector<T>& corners) const
    {
        std::vector<T> own(charts.surface.points().size());
        for (std::size_t s = 0; s < 3 * triangles.size(); ++s)
            own[static_cast<std::size_t>(charts.surface.cells()[s / 3][s % 3])] = corners[origin(s)];
        return own;
    }

    /// Writes the map of chart k to the whole surface. uv: one per vertex of the charts
    void write(std::size_t k, double energy, std::span<const vec2> uv, laid_surface& whole) const
    {
        for (auto i = static_cast<std::size_t>(charts.first_cell[k]);
             i < static_cast<std::size_t>(charts.first_cell[k + 1]); ++i)
        {
            whole.energy[static_cast<std::size_t>(triangles[i])] = energy;
            for (std::size_t s = 3 * i; s < 3 * i + 3; ++s)
                whole.uv[origin(s)] = uv[static_cast<std::size_t>(charts.surface.cells()[i][s % 3])];
        }
    }
};

/// Cuts whole charts out of a surface.
/// triangles: all those of the charts, ascending; seam: one flag per side of the surface
inline surface_part part_of(const mesh<triangle>& m, std::span<const idx> triangles, std::span<const char> seam)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    std::vector<char> part_seam;
    std::vector<idx> number(m.points().size(), -1);
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
    const mesh<triangle> surface(std::move(points), std::move(cells));
    surface_part part{cut_charts(surface, facets(surface), part_seam), {}};
    for (const idx c : part.charts.cell_origins) part.triangles.push_back(triangles[u(c)]);
    return part;
}

/// The same. wanted: one flag per triangle
inline surface_part part_of(const mesh<triangle>& m, std::span<const char> wanted, std::span<const char> seam)
{
    std::vector<idx> triangles;
    for (std::size_t c = 0; c < wanted.size(); ++c)
        if (wanted[c]) triangles.push_back(static_cast<idx>(c));
    return part_of(m, triangles, seam);
}

} // namespace taut::impl
