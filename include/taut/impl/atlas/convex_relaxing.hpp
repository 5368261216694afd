// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include <taut/impl/atlas/chart_mesh.hpp>
#include <taut/impl/atlas/crossing_charts.hpp>
#include <taut/impl/exact/convex_polygons.hpp>
#include <taut/impl/start/isometric_newton.hpp>

namespace taut::impl
{

/// One flag a chart: 1 where a polygon that is convex in space has a corner that does not turn left; exact.
inline std::vector<char> charts_with_concave(const chart_mesh& charts, const convex_polygons& polygons,
                                             std::span<const vec2> uv)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    std::vector<char> concave(u(charts.charts()), 0);
    for (const auto& [a, b, c] : polygons.corners)
    {
        if (orient2d(uv[u(a)], uv[u(b)], uv[u(c)]) > 0) continue;
        const auto next = std::upper_bound(charts.first_vertex.begin(), charts.first_vertex.end(), b);
        concave[static_cast<std::size_t>(next - charts.first_vertex.begin()) - 1] = 1;
    }
    return concave;
}

/// Lowers the isometric energy of a chart by Newton's method while the corners of its convex polygons keep turning
/// left: the triangles at them have the energy's barrier as those of the chart, but little weight. So all ways to cut a
/// polygon stay positive. The chart stays as it is where its border would meet itself.
inline void relax_convex(const chart_mesh& charts, std::size_t k, const convex_polygons& polygons, std::span<vec2> uv,
                         const std::function<bool()>& proceed)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    constexpr int steps = 30;
    constexpr double gain = 1e-5, light = 0.02; // least gain of a step; weight of a corner by its area
    const idx low = charts.first_vertex[k], high = charts.first_vertex[k + 1];
    const auto& points = charts.surface.points();
    std::vector<std::array<idx, 3>> cells(charts.surface.cells().begin() + charts.first_cell[k],
                                          charts.surface.cells().begin() + charts.first_cell[k + 1]);
    const std::size_t own = cells.size();
    for (const auto& t : polygons.corners)
        if (t[0] >= low && t[0] < high) cells.push_back(t);
    std::vector<double> weights;
    for (std::size_t i = 0; i < cells.size(); ++i)
    {
        auto& t = cells[i];
        const double area =
            glm::length(glm::cross(points[u(t[1])] - points[u(t[0])], points[u(t[2])] - points[u(t[0])]));
        weights.push_back((i < own ? 0.5 : 0.5 * light) * area);
        for (idx& v : t) v -= low;
    }
    std::vector<vec2> x(uv.begin() + low, uv.begin() + high);
    const std::vector<vec2> before = x;
    isometric_newton newton({points.data() + low, before.size()}, cells, std::vector<char>(x.size(), 0), weights);
    double here = newton.value(x);
    for (int i = 0; i < steps && here < std::numeric_limits<double>::infinity() && proceed(); ++i)
    {
        const double there = newton.step(x, here);
        const bool ends = !(here - there > gain * here);
        here = there;
        if (ends) break;
    }
    std::copy(x.begin(), x.end(), uv.begin() + low);
    const auto is_turned = [&](const std::array<idx, 3>& t)
    { return orient2d(x[u(t[0])], x[u(t[1])], x[u(t[2])]) <= 0; };
    if (std::any_of(cells.begin(), cells.end(), is_turned) || overlaps_itself(charts, k, uv))
        std::copy(before.begin(), before.end(), uv.begin() + low);
}

} // namespace taut::impl
