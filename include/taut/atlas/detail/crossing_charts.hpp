// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/atlas/chart_mesh.hpp>
#include <taut/core/parallel.hpp>
#include <taut/exact/crossings.hpp>
#include <taut/mesh/boundary.hpp>

namespace taut::detail
{

/// The boundary edges of charts, those of a chart in one piece.
struct chart_borders
{
    std::vector<std::array<idx, 2>> edges;
    std::vector<idx> first; ///< #charts + 1

    explicit chart_borders(const chart_mesh& charts) : chart_borders(charts, facets(charts.surface)) {}

    chart_borders(const chart_mesh& charts, const facet_table& f) : first{0}
    {
        for (std::size_t k = 0; k + 1 < charts.first_cell.size(); ++k)
        {
            for (idx s = 3 * charts.first_cell[k]; s < 3 * charts.first_cell[k + 1]; ++s)
                if (f.twin[static_cast<std::size_t>(s)] < 0) edges.push_back(side_vertices(charts.surface, s));
            first.push_back(static_cast<idx>(edges.size()));
        }
    }

    std::span<const std::array<idx, 2>> of(std::size_t chart) const
    {
        const auto begin = static_cast<std::size_t>(first[chart]);
        return std::span(edges).subspan(begin, static_cast<std::size_t>(first[chart + 1]) - begin);
    }
};

/// One flag a chart: 1 where its border meets itself. A chart without flips and branch points whose border does not is
/// covered once: the loops of a chart of genus 0 cannot be simple, disjoint and yet lie otherwise than around it and
/// its holes, as the turns of their tangents sum up to its Euler characteristic.
/// uv: one a vertex of charts.surface, finite
inline std::vector<char> crossing_charts(const chart_mesh& charts, std::span<const vec2> uv)
{
    const chart_borders borders(charts);
    std::vector<char> crossing(static_cast<std::size_t>(charts.charts()), 0);
    parallel_for(
        crossing.size(),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t k = begin; k < end; ++k)
                crossing[k] = !for_each_meeting(borders.of(k), uv, [](std::size_t, std::size_t) { return false; });
        },
        0, 8);
    return crossing;
}

} // namespace taut::detail
