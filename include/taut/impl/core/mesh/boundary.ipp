// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/impl/core/mesh/facets.hpp>
#include <taut/mesh.hpp>

namespace taut
{

std::vector<std::vector<idx>> boundary_loops(const mesh<triangle>& m)
{
    return boundary_loops(m, impl::facets(m));
}

} // namespace taut

namespace taut::impl
{

std::vector<std::vector<idx>> boundary_loops(const mesh<triangle>& m, const impl::facet_table& f)
{
    if (!f.manifold())
        throw mesh_error(
            mesh_error::non_manifold_facet, {f.crowds[0].begin(), f.crowds[0].end()},
            "boundary_loops: an edge has three or more triangles; part them, `taut check` and validate() list all");
    if (!f.oriented())
        throw mesh_error(
            mesh_error::inconsistent_orientation, {f.clash[0][0] / 3, f.clash[0][1] / 3},
            "boundary_loops: neighbours are oriented differently; turn one over, `taut check` and validate() list all");

    std::vector<char> seen(f.twin.size(), 0);
    std::vector<std::vector<idx>> loops;
    for (std::size_t start = 0; start < f.twin.size(); ++start)
    {
        if (f.twin[start] != impl::facet_table::boundary || seen[start]) continue;
        std::vector<idx> loop;
        auto side = static_cast<idx>(start);
        do {
            seen[static_cast<std::size_t>(side)] = 1;
            loop.push_back(impl::side_vertices(m, side)[0]);
            side = impl::next_boundary_side(f, side);
        } while (side != static_cast<idx>(start));
        std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
        loops.push_back(std::move(loop));
    }
    std::sort(loops.begin(), loops.end());
    return loops;
}

} // namespace taut::impl

namespace taut::impl
{

template std::vector<std::array<idx, 2>> boundary_facets(const mesh<triangle>&, const facet_table&);
template std::vector<std::array<idx, 2>> boundary_facets(const mesh<triangle>&);
template std::vector<std::array<idx, 3>> boundary_facets(const mesh<tetrahedron>&, const facet_table&);
template std::vector<std::array<idx, 3>> boundary_facets(const mesh<tetrahedron>&);

} // namespace taut::impl
