// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/core/mesh/facets.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Boundary facets, oriented as the boundary of the mesh: edges with the surface to their left, or triangles whose
/// normals point out of the volume.
template <class Element>
std::vector<std::array<idx, Element::dimension>> boundary_facets(const mesh<Element>& m, const facet_table& f)
{
    std::vector<std::array<idx, Element::dimension>> result;
    for (std::size_t s = 0; s < f.twin.size(); ++s)
        if (f.twin[s] == facet_table::boundary) result.push_back(impl::side_vertices(m, static_cast<idx>(s)));
    return result;
}

template <class Element>
std::vector<std::array<idx, Element::dimension>> boundary_facets(const mesh<Element>& m)
{
    return boundary_facets(m, facets(m));
}

/// The boundary side that starts where a boundary side of triangles ends: turns about that vertex until an edge has no
/// twin. `f` has no clash.
inline idx next_boundary_side(const facet_table& f, idx side)
{
    const auto after = [](idx s) { return s % 3 == 2 ? s - 2 : s + 1; };
    side = after(side);
    while (f.twin[static_cast<std::size_t>(side)] != facet_table::boundary)
        side = after(f.twin[static_cast<std::size_t>(side)]);
    return side;
}

/// boundary_loops() of a surface whose facets are f.
std::vector<std::vector<idx>> boundary_loops(const mesh<triangle>& m, const impl::facet_table& f);

/// Flags of the vertices on these loops.
inline std::vector<char> boundary_flags(std::size_t vertices, std::span<const std::vector<idx>> loops)
{
    std::vector<char> flags(vertices, 0);
    for (const auto& loop : loops)
        for (const idx v : loop) flags[static_cast<std::size_t>(v)] = 1;
    return flags;
}

// Compiled once, with the bodies.
extern template std::vector<std::array<idx, 2>> boundary_facets(const mesh<triangle>&, const facet_table&);

extern template std::vector<std::array<idx, 2>> boundary_facets(const mesh<triangle>&);

extern template std::vector<std::array<idx, 3>> boundary_facets(const mesh<tetrahedron>&, const facet_table&);

extern template std::vector<std::array<idx, 3>> boundary_facets(const mesh<tetrahedron>&);

} // namespace taut::impl
