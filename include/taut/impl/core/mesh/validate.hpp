// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/impl/core/mesh/manifold.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Finds every fault of the mesh, one finding per kind, the most basic first. Empty: the mesh is as required. Boundary
/// and handles are checked where the mesh is an oriented manifold. `f` are the facets of m.
template <class Element>
std::vector<mesh_finding> check(const mesh<Element>& m, const impl::facet_table& f, const mesh_requirements& need = {})
{
    std::vector<mesh_finding> found;
    const auto report = [&](mesh_error::fault_type fault, std::vector<idx> ids)
    { found.push_back(describe<Element>(fault, std::move(ids))); };
    const auto report_any = [&](mesh_error::fault_type fault, std::vector<idx> ids)
    {
        if (!ids.empty()) report(fault, std::move(ids));
    };

    auto [flat, inverted] = impl::bad_rest_cells(m);
    report_any(mesh_error::degenerate_cell, std::move(flat));
    report_any(mesh_error::inverted_cell, std::move(inverted));

    auto duplicates = impl::duplicate_cells(m, f);
    const bool no_duplicates = duplicates.empty();
    report_any(mesh_error::duplicate_cell, std::move(duplicates));
    report_any(impl::orientable(f, Element::corners) ? mesh_error::inconsistent_orientation
                                                     : mesh_error::not_orientable,
               impl::clashing_cells(m, f));
    report_any(mesh_error::non_manifold_facet, impl::crowded_facets(m, f));
    auto pinched = impl::pinched_vertices(m, f);
    const bool manifold = pinched.empty() && no_duplicates && f.oriented();
    report_any(mesh_error::non_manifold_vertex, std::move(pinched));

    const auto parts = impl::components(m);
    if (need.referenced) report_any(mesh_error::unreferenced_vertex, parts.unreferenced);
    if (need.connected && parts.first.size() > 1) report(mesh_error::several_components, parts.first);

    if constexpr (Element::dimension == 2)
    {
        if (!manifold) return found;
        const auto loops = boundary_loops(m, f);
        if (need.open && loops.empty()) report(mesh_error::closed_surface, {});
        if (need.one_boundary && loops.size() > parts.first.size())
        {
            std::vector<idx> first;
            for (const auto& loop : loops) first.push_back(loop[0]);
            report(mesh_error::several_boundaries, std::move(first));
        }
        // Euler: V - E + F = 2 components - loops - 2 handles. An edge has two sides, or one on the boundary.
        long long rim = 0;
        for (const auto& loop : loops) rim += static_cast<long long>(loop.size());
        const long long edges = (3LL * m.cell_count() + rim) / 2;
        const long long vertices = m.vertex_count() - static_cast<long long>(parts.unreferenced.size());
        const long long sphere = 2 * static_cast<long long>(parts.first.size()) - static_cast<long long>(loops.size());
        if (need.no_handles && vertices - edges + m.cell_count() != sphere) report(mesh_error::handles, {});
    }
    return found;
}

/// Throws the first finding of check() as a mesh_error.
template <class Element>
void validate(const mesh<Element>& m, const impl::facet_table& f, const mesh_requirements& need = {})
{
    auto found = check(m, f, need);
    if (!found.empty()) throw mesh_error(std::move(found.front()));
}

// Compiled once, with the bodies.
extern template std::vector<mesh_finding> check(const mesh<triangle>&, const impl::facet_table&,
                                                const mesh_requirements&);

extern template std::vector<mesh_finding> check(const mesh<tetrahedron>&, const impl::facet_table&,
                                                const mesh_requirements&);

} // namespace taut::impl
