// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_border.hpp>
#include <taut/impl/charts/atlas/crossing_charts.hpp>

namespace taut::impl
{

/// Shape of a chart in the plane.
struct laid_shape
{
    bool crosses = false;                     ///< it overlaps itself
    double fill = 1;                          ///< its area by that of its convex hull
    std::vector<std::array<idx, 2>> meetings; ///< pairs of triangles whose sides on the border meet: most of them
};

inline double cross(const vec2& a, const vec2& b, const vec2& c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The area of the convex hull of points, which are sorted (Andrew 1979).
inline double hull_area(std::vector<vec2> points)
{
    std::sort(points.begin(), points.end(),
              [](const vec2& a, const vec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    double twice = 0;
    for (const double turn : {1.0, -1.0}) // below, above
    {
        std::vector<vec2> chain;
        for (const vec2& p : points)
        {
            while (chain.size() > 1 && turn * cross(chain[chain.size() - 2], chain.back(), p) <= 0) chain.pop_back();
            chain.push_back(p);
        }
        for (std::size_t i = 1; i < chain.size(); ++i) twice += turn * cross(points.front(), chain[i - 1], chain[i]);
    }
    return twice / 2;
}

/// Triangles at the sides of a chart's border that meet.
inline std::vector<std::array<idx, 2>> meeting_triangles(const chart_mesh& charts, std::size_t chart,
                                                         std::span<const std::vector<idx>> loops,
                                                         std::span<const vec2> uv)
{
    constexpr std::size_t enough = 8; // of a side
    const auto edges = edges_of(loops);
    const auto sorted = [](idx a, idx b) { return std::array{std::min(a, b), std::max(a, b)}; };
    std::vector<std::pair<std::array<idx, 2>, idx>> sides; // of all triangles
    for (idx c = charts.first_cell[chart]; c < charts.first_cell[chart + 1]; ++c)
    {
        const auto& t = charts.surface.cells()[static_cast<std::size_t>(c)];
        for (std::size_t k = 0; k < 3; ++k) sides.push_back({sorted(t[k], t[(k + 1) % 3]), c});
    }
    std::sort(sides.begin(), sides.end());
    const auto triangle = [&](const std::array<idx, 2>& e)
    { return std::lower_bound(sides.begin(), sides.end(), std::pair(sorted(e[0], e[1]), idx(0)))->second; };
    std::vector<std::array<idx, 2>> meetings;
    std::vector<std::size_t> count(edges.size(), 0);
    for_each_meeting(
        edges, uv,
        [&](std::size_t i, std::size_t j)
        {
            if (std::min(count[i], count[j]) < enough) meetings.push_back({triangle(edges[i]), triangle(edges[j])});
            ++count[i];
            ++count[j];
            return true;
        },
        1000 * edges.size());
    return meetings;
}

/// Shapes of charts, one each; undefined for those without a map, whose energy is infinite. whole: false to find only
/// the charts that overlap themselves
inline std::vector<laid_shape> laid_shapes(const chart_mesh& charts, std::span<const vec2> uv,
                                           std::span<const double> energy, bool whole)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    std::vector<laid_shape> shapes(u(charts.charts()));
    parallel_for(
        shapes.size(),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; ++i)
            {
                if (!(energy[i] < std::numeric_limits<double>::infinity())) continue;
                shapes[i].crosses = overlaps_itself(charts, i, uv);
                if (!whole) continue;
                const auto loops = border_loops(charts, static_cast<idx>(i));
                if (shapes[i].crosses) shapes[i].meetings = meeting_triangles(charts, i, loops, uv);
                std::vector<vec2> rim;
                for (const auto& loop : loops)
                    for (const idx v : loop) rim.push_back(uv[u(v)]);
                double area = 0;
                for (auto c = u(charts.first_cell[i]); c < u(charts.first_cell[i + 1]); ++c)
                {
                    const auto& t = charts.surface.cells()[c];
                    area += cross(uv[u(t[0])], uv[u(t[1])], uv[u(t[2])]) / 2;
                }
                shapes[i].fill = area / hull_area(std::move(rim));
            }
        },
        0, 2);
    return shapes;
}

} // namespace taut::impl
