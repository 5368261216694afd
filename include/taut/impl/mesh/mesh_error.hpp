// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/fault_error.hpp>
#include <taut/impl/core/name_in.hpp>

namespace taut::impl
{

/// Faults of a mesh. The first five make it unusable and are found by the constructor of mesh; the others are found by
/// check() and validate(). The comment says what mesh_error::ids() holds.
struct mesh_faults
{
    enum fault_kind
    {
        empty,                    ///< no cells; no ids
        too_large,                ///< more vertices or corners than 32-bit numbers can name; no ids
        index_out_of_range,       ///< cell, vertex
        non_finite,               ///< vertices with a NaN or infinite coordinate
        repeated_vertex,          ///< cells that name one vertex twice
        degenerate_cell,          ///< cells that are flat at rest
        inverted_cell,            ///< tetrahedra of negative rest volume
        duplicate_cell,           ///< cells in pairs with the same corners
        inconsistent_orientation, ///< cells in pairs that run along their common facet the same way
        not_orientable,           ///< cells in pairs where no choice of orientation agrees
        non_manifold_facet,       ///< vertices of facets with three or more cells, `dimension` of them a facet
        non_manifold_vertex,      ///< vertices whose cells do not form one fan
        unreferenced_vertex,      ///< vertices without a cell
        several_components,       ///< one vertex of each component
        closed_surface,           ///< no ids
        several_boundaries,       ///< one vertex of each boundary loop
        handles                   ///< no ids
    };
};
using mesh_fault = mesh_faults::fault_kind;

/// Stable identifier of a fault, for programs.
constexpr const char* to_string(mesh_fault fault)
{
    return taut::impl::name_in<mesh_fault::handles>(
        {"empty", "too_large", "index_out_of_range", "non_finite", "repeated_vertex", "degenerate_cell",
         "inverted_cell", "duplicate_cell", "inconsistent_orientation", "not_orientable", "non_manifold_facet",
         "non_manifold_vertex", "unreferenced_vertex", "several_components", "closed_surface", "several_boundaries",
         "handles"},
        fault);
}

/// One fault of a mesh, the ids it concerns, and a sentence with the remedy.
struct mesh_finding
{
    mesh_fault fault;
    std::vector<idx> ids; ///< 0-based; which kind: see mesh_fault
    std::string message;
};

} // namespace taut::impl

namespace taut
{

/// Error of a mesh that cannot be used. what() names the first ids and the remedy; ids() has all of them.
class mesh_error : public impl::mesh_faults, public impl::fault_error<impl::mesh_fault>
{
public:
    using fault_error::fault_error;

    // NOLINTNEXTLINE(bugprone-throw-keyword-missing): a base, for clang-tidy 14
    explicit mesh_error(impl::mesh_finding found) : fault_error(found.fault, std::move(found.ids), found.message) {}
};

} // namespace taut
