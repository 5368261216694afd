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

/// Lays a chart whose triangles are those of one polygon on a circle, corner after corner by the lengths of its edges:
/// whatever shape it has in space, all its triangles are positive then, and none is over another. A polygon with holes
/// stays as it is.
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
