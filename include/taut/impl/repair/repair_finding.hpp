// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/error.hpp>
#include <taut/impl/core/name_in.hpp>
#include <taut/impl/core/types.hpp>

namespace taut::impl
{

/// Defects that repair_surface() repairs. Where mesh_fault has the same, the word is the same. The comment names the
/// remedy, and what repair_kind::ids holds.
enum class repair_kind
{
    index_out_of_range,       ///< left out: triangles that name a vertex which does not exist
    non_finite,               ///< left out with their triangles: vertices with a NaN or infinite coordinate
    repeated_vertex,          ///< left out: triangles that name a vertex twice
    degenerate_cell,          ///< left out: flat triangles
    duplicate_cell,           ///< all but one left out: pairs of triangles, the one that stays first
    unreferenced_vertex,      ///< left out: vertices without a triangle
    coincident_vertex,        ///< welded: pairs of vertices, the one that stays first
    inconsistent_orientation, ///< turned over: triangles
    not_orientable,           ///< cut open: edges, two vertices each
    non_manifold_facet,       ///< parted: edges with three or more triangles, two vertices each
    non_manifold_vertex,      ///< one made for each fan: vertices whose triangles form several fans
    contradicting_normal      ///< nothing, they are named: triangles that all three normals at their corners oppose
};

/// Stable identifier of a defect, for programs.
constexpr const char* to_string(repair_kind kind)
{
    return taut::impl::name_in<repair_kind::contradicting_normal>(
        {"index_out_of_range", "non_finite", "repeated_vertex", "degenerate_cell", "duplicate_cell",
         "unreferenced_vertex", "coincident_vertex", "inconsistent_orientation", "not_orientable", "non_manifold_facet",
         "non_manifold_vertex", "contradicting_normal"},
        kind);
}

/// Number of ids of a defect of a kind: 2 for edges and pairs.
constexpr int ids_each(repair_kind kind)
{
    return kind == repair_kind::duplicate_cell || kind == repair_kind::coincident_vertex ||
                   kind == repair_kind::not_orientable || kind == repair_kind::non_manifold_facet
               ? 2
               : 1;
}

/// Returns whether no charts can be made of a mesh with this defect. Other defects are repaired, too.
constexpr bool is_fault(repair_kind kind)
{
    return kind != repair_kind::unreferenced_vertex && kind != repair_kind::coincident_vertex &&
           kind != repair_kind::contradicting_normal;
}

/// Defects of one kind, with the ids they concern.
struct repair_finding
{
    repair_kind kind;
    std::vector<idx> ids; ///< in the numbering of the input, from 0; which kind: see repair_kind
    std::string problem;  ///< "3 triangles (4, 7, 9) flat at rest"
    std::string action;   ///< "left out"

    std::string message() const { return problem + "; " + action; }
};

} // namespace taut::impl

namespace taut
{

/// Error of an input of which no triangle is left after repair.
class repair_error : public error
{
public:
    repair_error(const std::string& what, std::vector<impl::repair_finding> findings)
        : error(what), findings_(std::move(findings))
    {
    }

    /// Defects for which all triangles were removed.
    const std::vector<impl::repair_finding>& findings() const noexcept { return findings_; }

private:
    std::vector<impl::repair_finding> findings_;
};

} // namespace taut
