// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include <taut/impl/atlas/chart_mesh.hpp>
#include <taut/impl/exact/convex_polygons.hpp>

namespace taut::impl
{

/// Maps a chart of a single polygon to a circle, corner after corner by the lengths of its edges: whatever its shape in
/// space, all its triangles are then positive and disjoint. A polygon with holes is not changed.
inline void lay_round(const chart_mesh& charts, std::size_t k, std::span<vec2> uv)
{
    std::vector<idx> cells(static_cast<std::size_t>(charts.first_cell[k + 1] - charts.first_cell[k]));
    std::iota(cells.begin(), cells.end(), charts.first_cell[k]);
    const auto loop = outline_of(charts.surface.cells(), cells);
    std::vector<double> way{0};
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
        const auto at = [&](std::size_t j)
        { return charts.surface.points()[static_cast<std::size_t>(loop[j % loop.size()])]; };
        way.push_back(way.back() + glm::distance(at(i), at(i + 1)));
    }
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
        const double angle = 2 * std::numbers::pi * way[i] / way.back(), radius = way.back() / (2 * std::numbers::pi);
        uv[static_cast<std::size_t>(loop[i])] = radius * vec2(std::cos(angle), std::sin(angle));
    }
}

} // namespace taut::impl
