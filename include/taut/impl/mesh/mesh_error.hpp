// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/error.hpp>
#include <taut/impl/core/types.hpp>

namespace taut
{

/// Faults of a mesh. The first five make it unusable and are found by the constructor of mesh; the others are found by
/// check() and validate(). The comment says what mesh_error::ids() holds.
enum class mesh_fault
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

/// Stable identifier of a fault, for programs.
constexpr const char* to_string(mesh_fault fault)
{
    switch (fault)
    {
    case mesh_fault::empty:
        return "empty";
    case mesh_fault::too_large:
        return "too_large";
    case mesh_fault::index_out_of_range:
        return "index_out_of_range";
    case mesh_fault::non_finite:
        return "non_finite";
    case mesh_fault::repeated_vertex:
        return "repeated_vertex";
    case mesh_fault::degenerate_cell:
        return "degenerate_cell";
    case mesh_fault::inverted_cell:
        return "inverted_cell";
    case mesh_fault::duplicate_cell:
        return "duplicate_cell";
    case mesh_fault::inconsistent_orientation:
        return "inconsistent_orientation";
    case mesh_fault::not_orientable:
        return "not_orientable";
    case mesh_fault::non_manifold_facet:
        return "non_manifold_facet";
    case mesh_fault::non_manifold_vertex:
        return "non_manifold_vertex";
    case mesh_fault::unreferenced_vertex:
        return "unreferenced_vertex";
    case mesh_fault::several_components:
        return "several_components";
    case mesh_fault::closed_surface:
        return "closed_surface";
    case mesh_fault::several_boundaries:
        return "several_boundaries";
    case mesh_fault::handles:
        return "handles";
    }
    return "unknown";
}

} // namespace taut

namespace taut::impl
{

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
class mesh_error : public error
{
public:
    explicit mesh_error(impl::mesh_finding finding)
        : error(finding.message), fault_(finding.fault), ids_(std::move(finding.ids))
    {
    }
    mesh_error(mesh_fault fault, std::vector<idx> ids, const std::string& message)
        : error(message), fault_(fault), ids_(std::move(ids))
    {
    }

    mesh_fault fault() const noexcept { return fault_; }
    const std::vector<idx>& ids() const noexcept { return ids_; }

private:
    mesh_fault fault_;
    std::vector<idx> ids_;
};

} // namespace taut
