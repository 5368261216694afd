// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/core/counting_sort.hpp>
#include <taut/core/disjoint_sets.hpp>
#include <taut/mesh/facets.hpp>

namespace taut
{

/// A surface cut apart into charts: one mesh, with the triangles and the vertices of a chart in one piece, charts in
/// the order of their first triangles, triangles and vertices of a chart in the order of the surface.
struct chart_mesh
{
    mesh<triangle> surface;
    std::vector<idx> first_cell;     ///< #charts + 1
    std::vector<idx> first_vertex;   ///< #charts + 1
    std::vector<idx> cell_origins;   ///< the triangle of the surface, one a triangle; corners keep their places
    std::vector<idx> vertex_origins; ///< the vertex of the surface, one a vertex

    idx charts() const noexcept { return static_cast<idx>(first_cell.size()) - 1; }
};

/// Marks the sides where charts meet.
/// chart: one label a triangle
/// Returns one flag a side of the surface, whose facets `f` are: 1 where the triangles of an edge differ in label.
inline std::vector<char> seams_between(const facet_table& f, std::span<const idx> chart)
{
    std::vector<char> seam(f.twin.size(), 0);
    for (std::size_t s = 0; s < seam.size(); ++s)
        if (f.twin[s] >= 0) seam[s] = chart[s / 3] != chart[static_cast<std::size_t>(f.twin[s]) / 3];
    return seam;
}

/// Marks the sides along which a map by corners is torn: where two triangles have other places for a common vertex, or
/// places that are no numbers.
/// uv: a triple for each triangle of m, whose facets `f` are. Returns one flag a side.
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

/// Cuts a surface apart along seams. What hangs together across other edges is a chart, and a vertex becomes one vertex
/// for each of the fans that seams part its triangles into.
/// m:    without crowded facets (mesh/facets.hpp), which are `f`
/// seam: one flag a side, the same on both sides of an edge; sides without a twin need none
inline chart_mesh cut_charts(const mesh<triangle>& m, const facet_table& f, std::span<const char> seam)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    const idx cells = m.cell_count();
    disjoint_sets parts(cells), fans(3 * cells); // of triangles, of corners
    for (idx s = 0; s < 3 * cells; ++s)
    {
        const idx t = f.twin[u(s)];
        if (t < s || seam[u(s)]) continue;
        parts.join(s / 3, t / 3);
        const auto next = [](idx side, idx by) { return side / 3 * 3 + (side % 3 + by) % 3; };
        for (const idx a : {next(s, 1), next(s, 2)}) // the corners at the ends of the edge
            for (const idx b : {next(t, 1), next(t, 2)})
                if (m.cells()[u(a / 3)][u(a % 3)] == m.cells()[u(b / 3)][u(b % 3)]) fans.join(a, b);
    }

    std::vector<idx> chart(u(cells), -1);
    idx charts = 0;
    for (idx c = 0; c < cells; ++c) // the smallest triangle stands for a part and comes first
        chart[u(c)] = parts.find(c) == c ? charts++ : chart[u(parts.find(c))];
    const auto by_chart = [&](std::size_t n, auto&& chart_of)
    {
        std::vector<idx> order(n);
        auto start = detail::counting_sort(n, u(charts), chart_of,
                                           [&](std::size_t i, std::size_t at) { order[at] = static_cast<idx>(i); });
        return std::pair(std::vector<idx>(start.begin(), start.end()), std::move(order));
    };
    auto [first_cell, cell_origins] = by_chart(u(cells), [&](std::size_t c) { return chart[c]; });

    // Fans in the order of their vertices in the surface, then by chart.
    std::vector<idx> fan_of(3 * u(cells)), first_corner;
    for (idx a = 0; a < 3 * cells; ++a)
        if (fans.find(a) == a) first_corner.push_back(a);
    std::vector<idx> by_vertex(first_corner.size());
    detail::counting_sort(
        first_corner.size(), u(m.vertex_count()),
        [&](std::size_t i) { return m.cells()[u(first_corner[i] / 3)][u(first_corner[i] % 3)]; },
        [&](std::size_t i, std::size_t at) { by_vertex[at] = first_corner[i]; });
    auto [first_vertex, order] = by_chart(by_vertex.size(), [&](std::size_t i) { return chart[u(by_vertex[i] / 3)]; });

    std::vector<vec3> points(order.size());
    std::vector<idx> vertex_origins(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
    {
        const idx a = by_vertex[u(order[i])];
        fan_of[u(a)] = static_cast<idx>(i);
        vertex_origins[i] = m.cells()[u(a / 3)][u(a % 3)];
        points[i] = m.points()[u(vertex_origins[i])];
    }
    std::vector<std::array<idx, 3>> cut(u(cells));
    for (std::size_t i = 0; i < cut.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) cut[i][k] = fan_of[u(fans.find(3 * cell_origins[i] + static_cast<idx>(k)))];
    return {mesh<triangle>(std::move(points), std::move(cut)), std::move(first_cell), std::move(first_vertex),
            std::move(cell_origins), std::move(vertex_origins)};
}

} // namespace taut
