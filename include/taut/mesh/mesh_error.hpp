// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <taut/core/error.hpp>
#include <taut/core/types.hpp>

namespace taut
{

/// What can be wrong with a mesh. The first five make it unusable and are found by the constructor of mesh; the others
/// are found by check() and validate(). The comment says what mesh_error::ids() holds.
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

/// One fault with everything it concerns, and a sentence for people with the remedy.
struct mesh_finding
{
    mesh_fault fault;
    std::vector<index> ids; ///< 0-based; which kind: see mesh_fault
    std::string message;
};

/// A mesh that cannot be used. what() names the first ids and the remedy; ids() has all of them.
class mesh_error : public error
{
public:
    explicit mesh_error(mesh_finding finding)
        : error(finding.message), fault_(finding.fault), ids_(std::move(finding.ids))
    {
    }
    mesh_error(mesh_fault fault, std::vector<index> ids, const std::string& message)
        : error(message), fault_(fault), ids_(std::move(ids))
    {
    }

    mesh_fault fault() const noexcept { return fault_; }
    const std::vector<index>& ids() const noexcept { return ids_; }

private:
    mesh_fault fault_;
    std::vector<index> ids_;
};

} // namespace taut
