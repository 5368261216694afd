// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include <taut/elements.hpp>
#include <taut/impl/core/exact/cell_tetrahedra.hpp>
#include <taut/impl/core/exact/simplex_role.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Meshes whose simplices are the corners of cells of other kinds (quads, wedges, hexahedra, ...) and overlap. Corner 0
/// of a simplex is that of the cell, whose edges it spans; `owners` has the cell of each simplex, those of a cell one
/// after the other. A simplex without others of its cell is that cell. Without owners all are cells. 24 further
/// tetrahedra after the 8 at the corners of a hexahedron, and 6 after the 6 of a wedge, are those at its edges.
///
/// Boundary facets of such a mesh, as simplices with the normal of the boundary: of a quad the triangles at its four
/// corners.
template <class Element>
std::vector<std::array<idx, Element::dimension>> boundary_facets(const mesh<Element>& m, std::span<const idx> owners)
{
    if (owners.empty()) return boundary_facets(m);
    constexpr std::size_t D = Element::dimension;
    struct side
    {
        std::array<idx, D> sorted, vertices;
        idx owner;
    };
    std::vector<side> sides;
    for (std::size_t first = 0, last = 0; first < owners.size(); first = last)
    {
        while (last < owners.size() && owners[last] == owners[first]) ++last;
        const std::size_t count = last - first, corners = impl::corner_simplex_count(count);
        for (std::size_t c = first; c < first + corners; ++c)
            for (idx k = count == 1 ? 0 : 1; k < Element::corners;
                 ++k) // what is opposite of a cell's corner lies inside
            {
                const auto v = impl::side_vertices(m, static_cast<idx>(c) * Element::corners + k);
                sides.push_back({v, v, owners[c]});
                std::sort(sides.back().sorted.begin(), sides.back().sorted.end());
            }
    }
    std::vector<std::size_t> order(sides.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b)
              { return sides[a].sorted != sides[b].sorted ? sides[a].sorted < sides[b].sorted : a < b; });
    std::vector<std::array<idx, D>> result;
    for (std::size_t first = 0, last = 0; first < order.size(); first = last)
    {
        const side& one = sides[order[first]];
        bool single = true;
        for (; last < order.size() && sides[order[last]].sorted == one.sorted; ++last)
            single = single && sides[order[last]].owner == one.owner;
        if (single) result.push_back(one.vertices);
    }
    return result;
}

/// The simplices at the corners of a cell of the element's dimension and so many corners, in VTK's order.
inline std::span<const std::array<std::size_t, 3>> corner_simplices(std::size_t count, triangle)
{
    using corners = std::array<std::size_t, 3>;
    static constexpr std::array<corners, 1> itself = {{{0, 1, 2}}};
    static constexpr std::array<corners, 4> quad = {{{0, 1, 3}, {1, 2, 0}, {2, 3, 1}, {3, 0, 2}}};
    if (count == 3) return itself;
    return quad;
}
inline std::span<const std::array<std::size_t, 4>> corner_simplices(std::size_t count, tetrahedron)
{
    return corner_tetrahedra(count);
}

/// A flag per triangle: lone ones, and of the four at the corners of a quad those at two opposite ones, which do not
/// overlap, so that these are the surface, once.
inline std::vector<char> triangle_cover(std::span<const idx> owners)
{
    std::vector<char> whole(owners.size());
    for (std::size_t c = 0, first = 0; c < owners.size(); ++c)
    {
        if (owners[c] != owners[first]) first = c;
        whole[c] = (c - first) % 2 == 0;
    }
    return whole;
}

} // namespace taut::impl
