// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/impl/core/core/disjoint_sets.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/mesh/facets.hpp>

namespace taut::impl
{

/// Charts with their maps before the surface is cut apart: in this form they are changed.
struct laid_surface
{
    std::vector<char> seam;     ///< one per side
    std::vector<vec2> uv;       ///< one per corner
    std::vector<double> energy; ///< one per triangle: of its chart
};

/// Lowest and highest corner of the box about points, of which there is one at least.
inline std::pair<vec2, vec2> box_about(std::span<const vec2> points)
{
    std::pair box(points.front(), points.front());
    for (const vec2& p : points) box = {glm::min(box.first, p), glm::max(box.second, p)};
    return box;
}

inline double triangle_area(const mesh<triangle>& m, idx c)
{
    const auto x = m.rest(c);
    return glm::length(glm::cross(x[1] - x[0], x[2] - x[0])) / 2;
}

/// Area of the triangles from `first` to `last`, that one left out.
inline double area_of(const mesh<triangle>& m, idx first, idx last)
{
    double sum = 0;
    for (idx c = first; c < last; ++c) sum += triangle_area(m, c);
    return sum;
}

/// A chart as a mesh of its own. Vertices and triangles keep their order.
inline mesh<triangle> chart_alone(const chart_mesh& charts, std::size_t k)
{
    const auto& points = charts.surface.points();
    const auto& cells = charts.surface.cells();
    const idx first = charts.first_vertex[k];
    std::vector<std::array<idx, 3>> own(cells.begin() + charts.first_cell[k], cells.begin() + charts.first_cell[k + 1]);
    for (auto& t : own)
        for (idx& v : t) v -= first;
    return {std::vector<vec3>(points.begin() + first, points.begin() + charts.first_vertex[k + 1]), std::move(own)};
}

/// Marks the sides where charts meet.
/// chart: one label per triangle
/// Returns one flag per side of the surface, whose facets `f` are: 1 where the triangles of an edge differ in label.
inline std::vector<char> seams_between(const facet_table& f, std::span<const idx> chart)
{
    std::vector<char> seam(f.twin.size(), 0);
    parallel_for(seam.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t s = begin; s < end; ++s)
                         if (f.twin[s] >= 0) seam[s] = chart[s / 3] != chart[static_cast<std::size_t>(f.twin[s]) / 3];
                 });
    return seam;
}

/// Polygon of each triangle, by the first of its triangles.
/// together: one flag per side of the surface, 1 on the diagonals of polygons; or empty
inline std::vector<idx> polygons_of(const facet_table& f, std::span<const char> together)
{
    disjoint_sets polygons(static_cast<idx>(f.twin.size()) / 3);
    for (std::size_t s = 0; s < together.size(); ++s)
        if (together[s] != 0 && f.twin[s] >= 0) polygons.join(static_cast<idx>(s) / 3, f.twin[s] / 3);
    std::vector<idx> polygon(f.twin.size() / 3);
    for (std::size_t c = 0; c < polygon.size(); ++c) polygon[c] = polygons.find(static_cast<idx>(c));
    return polygon;
}

/// Marks the sides along which a map by corners is discontinuous: where two triangles have different texture
/// coordinates for a common vertex, or non-finite ones.
/// uv: a triple for each triangle of m, whose facets `f` are. Returns one flag per side.
inline std::vector<char> seams_of_map(const mesh<triangle>& m, const facet_table& f,
                                      std::span<const std::array<vec2, 3>> uv)
{
    std::vector<char> seam(f.twin.size(), 0);
    for (std::size_t s = 0; s < seam.size(); ++s)
    {
        if (f.twin[s] < 0) continue;
        const auto t = static_cast<std::size_t>(f.twin[s]);
        for (const std::size_t k : {(s + 1) % 3, (s + 2) % 3})
            for (const std::size_t j : {(t + 1) % 3, (t + 2) % 3}) // positions in the triangles, as 3 divides 3 c
                if (m.cells()[s / 3][k] == m.cells()[t / 3][j] && uv[s / 3][k] != uv[t / 3][j]) seam[s] = 1;
    }
    return seam;
}

/// seam: one flag per side of a surface, whose facets are `f`
inline double length_of_seams(const mesh<triangle>& m, const facet_table& f, std::span<const char> seam)
{
    double length = 0;
    for (std::size_t s = 0; s < seam.size(); ++s)
    {
        if (f.twin[s] <= static_cast<idx>(s) || seam[s] == 0) continue;
        const auto [a, b] = side_vertices(m, static_cast<idx>(s));
        length += glm::distance(m.points()[static_cast<std::size_t>(a)], m.points()[static_cast<std::size_t>(b)]);
    }
    return length;
}

/// Sides of a surface, whose facets are `f`, at which two triangles have no common edge in its charts.
inline std::vector<char> seams_of(const chart_mesh& charts, const facet_table& f)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    std::vector<std::array<idx, 3>> corners(charts.surface.cells().size());
    for (std::size_t i = 0; i < corners.size(); ++i) corners[u(charts.cell_origins[i])] = charts.surface.cells()[i];
    std::vector<char> seam(f.twin.size(), 0);
    for (std::size_t s = 0; s < seam.size(); ++s)
    {
        if (f.twin[s] < 0) continue;
        const auto& other = corners[u(f.twin[s]) / 3];
        for (const std::size_t k : {(s + 1) % 3, (s + 2) % 3})
            if (std::find(other.begin(), other.end(), corners[s / 3][k]) == other.end()) seam[s] = 1;
    }
    return seam;
}

/// Connected pieces of a surface cut along seams: the piece of each triangle, pieces in the order of their first
/// triangles, and their number.
inline std::pair<std::vector<idx>, idx> pieces_between(const facet_table& f, std::span<const char> seam)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    std::vector<idx> piece(f.twin.size() / 3, -1), front;
    idx pieces = 0;
    for (idx first = 0; first < static_cast<idx>(piece.size()); ++first)
    {
        if (piece[u(first)] >= 0) continue;
        piece[u(first)] = pieces;
        for (front.push_back(first); !front.empty();)
        {
            const idx c = front.back();
            front.pop_back();
            for (idx s = 3 * c; s < 3 * c + 3; ++s)
            {
                if (f.twin[u(s)] < 0 || seam[u(s)]) continue;
                const idx next = f.twin[u(s)] / 3;
                if (piece[u(next)] >= 0) continue;
                piece[u(next)] = pieces;
                front.push_back(next);
            }
        }
        ++pieces;
    }
    return {std::move(piece), pieces};
}

/// Fans of triangles around vertices between seams.
struct vertex_fans
{
    std::vector<idx> of_corner;    ///< one per corner
    std::vector<idx> first_corner; ///< one per fan, ascending

    idx vertex(const mesh<triangle>& m, std::size_t fan) const
    {
        const auto corner = static_cast<std::size_t>(first_corner[fan]);
        return m.cells()[corner / 3][corner % 3];
    }
};

inline vertex_fans fans_between(const mesh<triangle>& m, const facet_table& f, std::span<const char> seam)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    const auto next = [](idx side, idx by) { return side / 3 * 3 + (side % 3 + by) % 3; };
    const auto vertex = [&](idx corner) { return m.cells()[u(corner / 3)][u(corner % 3)]; };
    vertex_fans fans{std::vector<idx>(f.twin.size(), -1), {}};
    for (idx first = 0; first < static_cast<idx>(f.twin.size()); ++first)
    {
        if (fans.of_corner[u(first)] >= 0) continue;
        const auto fan = static_cast<idx>(fans.first_corner.size());
        fans.first_corner.push_back(first);
        fans.of_corner[u(first)] = fan;
        for (const idx way : {1, 2}) // around the vertex, until a seam or a corner that was met
            for (idx s = next(first, way); f.twin[u(s)] >= 0 && !seam[u(s)];)
            {
                const idx t = f.twin[u(s)];
                const bool after = vertex(next(t, 1)) == vertex(first);
                const idx corner = next(t, after ? 1 : 2);
                if (fans.of_corner[u(corner)] >= 0) break;
                fans.of_corner[u(corner)] = fan;
                s = next(t, after ? 2 : 1);
            }
    }
    return fans;
}

/// cut_charts() of a surface whose facets are f.
inline chart_mesh cut_charts(const mesh<triangle>& m, const facet_table& f, std::span<const char> seam)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    const std::size_t cells = m.cells().size();
    std::vector<idx> chart;
    idx charts = 0;
    vertex_fans fans;
    parallel_for(
        2,
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t task = begin; task < end; ++task)
                if (task == 0)
                    std::tie(chart, charts) = pieces_between(f, seam);
                else
                    fans = fans_between(m, f, seam);
        },
        0, 1);
    const auto sorted = [](std::size_t n, idx rows, auto&& row_of)
    {
        std::vector<idx> order(n);
        auto start = counting_sort(n, static_cast<std::size_t>(rows), row_of,
                                   [&](std::size_t i, std::size_t at) { order[at] = static_cast<idx>(i); });
        return std::pair(std::move(start), std::move(order));
    };
    auto [first_cell, cell_origins] = sorted(cells, charts, [&](std::size_t c) { return chart[c]; });

    // Fans in the order of their vertices in the surface, then by chart.
    const auto by_vertex =
        sorted(fans.first_corner.size(), m.vertex_count(), [&](std::size_t i) { return fans.vertex(m, i); }).second;
    auto [first_vertex, order] = sorted(
        by_vertex.size(), charts, [&](std::size_t i) { return chart[u(fans.first_corner[u(by_vertex[i])] / 3)]; });

    std::vector<vec3> points(order.size());
    std::vector<idx> vertex_origins(order.size()), place(order.size()); // of each fan
    std::vector<std::array<idx, 3>> cut(cells);
    parallel_for(order.size(),
                 [&, &order = order](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t i = begin; i < end; ++i)
                     {
                         const idx fan = by_vertex[u(order[i])];
                         place[u(fan)] = static_cast<idx>(i);
                         vertex_origins[i] = fans.vertex(m, u(fan));
                         points[i] = m.points()[u(vertex_origins[i])];
                     }
                 });
    parallel_for(cells,
                 [&, &cell_origins = cell_origins](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t i = begin; i < end; ++i)
                         for (std::size_t k = 0; k < 3; ++k)
                             cut[i][k] = place[u(fans.of_corner[3 * u(cell_origins[i]) + k])];
                 });
    return {mesh<triangle>(std::move(points), std::move(cut)), std::move(first_cell), std::move(first_vertex),
            std::move(cell_origins), std::move(vertex_origins)};
}

} // namespace taut::impl
