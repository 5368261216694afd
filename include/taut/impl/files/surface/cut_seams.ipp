// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <taut/impl/core/core/disjoint_sets.hpp>
#include <taut/impl/core/mesh/facets.hpp>
#include <taut/surface_file.hpp>
#include <utility>
#include <vector>

namespace taut::io::impl
{

/// The corners of triangles. Joined are those of one corner of a polygon, and those that meet at an edge along which
/// both triangles agree.
inline taut::impl::disjoint_sets joined_corners(const surface_file& file)
{
    const auto& cells = file.surface.cells();
    const auto sides = taut::impl::facets(file.surface);
    taut::impl::disjoint_sets joined(3 * file.surface.cell_count());
    const auto ends = [](idx side)
    {
        const auto& local = triangle::facets[static_cast<std::size_t>(side % 3)];
        return std::array<idx, 2>{side / 3 * 3 + local[0], side / 3 * 3 + local[1]};
    };
    const auto vertex = [&](idx corner)
    { return cells[static_cast<std::size_t>(corner / 3)][static_cast<std::size_t>(corner % 3)]; };
    const auto texcoord = [&](idx corner)
    { return file.texcoord(static_cast<std::size_t>(corner / 3), static_cast<std::size_t>(corner % 3)); };
    const auto join = [&](idx s, idx t)
    {
        auto [a, b] = ends(s);
        auto [c, d] = ends(t);
        if (vertex(a) != vertex(c)) std::swap(c, d);
        if (texcoord(a) != texcoord(c) || texcoord(b) != texcoord(d)) return;
        joined.join(a, c);
        joined.join(b, d);
    };
    std::vector<idx> first(file.faces.corners.size(), -1);
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto corner = static_cast<idx>(3 * c + k);
            idx& other = first[file.faces.corner(c, k)];
            if (other < 0) other = corner;
            joined.join(other, corner);
        }
    for (std::size_t s = 0; s < sides.twin.size(); ++s)
        if (sides.twin[s] > static_cast<idx>(s)) join(static_cast<idx>(s), sides.twin[s]);
    for (const auto& crowd : sides.crowds)
        for (const idx side : crowd)
            if (side != crowd[0]) join(crowd[0], side);
    return joined;
}

} // namespace taut::io::impl

namespace taut::io
{

std::optional<cut_surface> surface_file::cut_seams() const
{
    const auto at = [](idx i) { return static_cast<std::size_t>(i); };
    auto points = surface.points();
    auto cells = surface.cells();
    std::vector<vec2> uv(points.size(), vec2(0.0));
    std::vector<idx> sets(points.size(), -1); // the set of corners that has the vertex of the file
    bool seams = false;
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const idx v = cells[c][k];
            const vec2 x = texcoord(c, k);
            if (sets[at(v)] < 0)
            {
                sets[at(v)] = static_cast<idx>(3 * c + k);
                uv[at(v)] = x;
            }
            seams = seams || uv[at(v)] != x;
        }
    if (!seams) return std::nullopt;

    auto joined = impl::joined_corners(*this);
    std::vector<idx> origins(points.size()), sheets(3 * cells.size(), -1);
    for (std::size_t v = 0; v < points.size(); ++v) origins[v] = static_cast<idx>(v);
    std::vector<char> divided(points.size(), 0);
    std::size_t seam_vertices = 0;
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const idx v = cells[c][k], set = joined.find(static_cast<idx>(3 * c + k));
            idx& sheet = sheets[at(set)];
            if (sheet < 0 && set == sets[at(v)]) // a set is called by its first corner, which is that of the vertex
                sheet = v;
            else if (sheet < 0)
            {
                sheet = static_cast<idx>(points.size());
                seam_vertices += divided[at(v)] ? 0 : 1;
                divided[at(v)] = 1;
                points.push_back(vec3(points[at(v)]));
                uv.push_back(texcoord(c, k));
                origins.push_back(v);
            }
            cells[c][k] = sheet;
        }
    auto corners = faces.corners;
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (std::size_t k = 0; k < 3; ++k) corners[faces.corner(c, k)] = cells[c][k];
    return cut_surface{mesh<triangle>(std::move(points), std::move(cells)), std::move(uv), std::move(origins),
                       std::move(corners), seam_vertices};
}

} // namespace taut::io
