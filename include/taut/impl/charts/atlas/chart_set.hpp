// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <taut/impl/charts/atlas/atlas_summary.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/charts/atlas/crossing_charts.hpp>

namespace taut::impl
{

/// Charts of a surface with their maps: what the phases of make_atlas() take and give.
struct chart_set
{
    std::vector<char> seam; ///< one per side of the surface
    chart_mesh charts;
    std::vector<vec2> uv;       ///< one per vertex of the charts, in units of the surface
    std::vector<double> energy; ///< one per chart; infinite: it has no map
};

/// Calls f(triangle of the surface, corner, vertex of the charts) for all corners.
template <class F>
void for_each_corner(const chart_mesh& charts, F&& f)
{
    const auto& cells = charts.surface.cells();
    for (std::size_t i = 0; i < cells.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            f(static_cast<std::size_t>(charts.cell_origins[i]), k, static_cast<std::size_t>(cells[i][k]));
}

/// Values of charts for the triangles of the surface.
template <class T>
std::vector<T> by_triangle(const chart_mesh& charts, const std::vector<T>& of_charts)
{
    std::vector<T> values(charts.cell_origins.size());
    for (std::size_t k = 0; k < of_charts.size(); ++k)
        for (idx i = charts.first_cell[k]; i < charts.first_cell[k + 1]; ++i)
            values[static_cast<std::size_t>(charts.cell_origins[static_cast<std::size_t>(i)])] = of_charts[k];
    return values;
}

/// The charts as a surface with seams.
inline laid_surface laid(const chart_set& set)
{
    laid_surface made{set.seam, std::vector<vec2>(set.seam.size()), by_triangle(set.charts, set.energy)};
    for_each_corner(set.charts, [&](std::size_t cell, std::size_t corner, std::size_t v)
                    { made.uv[3 * cell + corner] = set.uv[v]; });
    return made;
}

/// Cuts a surface, whose facets are `f`, along its seams.
inline chart_set cut(const mesh<triangle>& m, const facet_table& f, laid_surface laid)
{
    chart_mesh charts = cut_charts(m, f, laid.seam);
    std::vector<vec2> uv(charts.surface.points().size());
    for_each_corner(charts,
                    [&](std::size_t cell, std::size_t corner, std::size_t v) { uv[v] = laid.uv[3 * cell + corner]; });
    std::vector<double> energy;
    for (std::size_t k = 0; k + 1 < charts.first_cell.size(); ++k)
        energy.push_back(laid.energy[static_cast<std::size_t>(charts.first_triangle(k))]);
    return {std::move(laid.seam), std::move(charts), std::move(uv), std::move(energy)};
}

/// Computes the energies of all charts from their maps.
inline void measure(chart_set& set)
{
    const ideal_elements<triangle> ideal(set.charts.surface);
    for (std::size_t k = 0; k < set.energy.size(); ++k)
        set.energy[k] = area_and_energy(set.charts, k, set.uv, ideal).second;
}

/// One flag per chart: 1 where it has no map, or overlaps itself.
inline std::vector<char> unfit(const chart_set& set)
{
    auto bad = crossing_charts(set.charts, set.uv);
    for (std::size_t k = 0; k < bad.size(); ++k)
        bad[k] = bad[k] != 0 || !(set.energy[k] < std::numeric_limits<double>::infinity());
    return bad;
}

} // namespace taut::impl
