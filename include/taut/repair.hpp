// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#if TAUT_OPEN == 1 // the parts that its calls need
#define TAUT_PART_REPAIR
#endif
#ifndef TAUT_REPAIR_HPP
#define TAUT_REPAIR_HPP

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/core/name_in.hpp>
#include <taut/mesh.hpp>
#include <taut/types.hpp>

/// Repairs triangle soups to manifold meshes.
namespace taut
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

/// Defects of one kind, with the ids they concern.
struct repair_finding
{
    repair_kind kind;
    std::vector<idx> ids; ///< in the numbering of the input, from 0; which kind: see repair_kind
    std::string problem;  ///< "3 triangles (4, 7, 9) flat at rest"
    std::string action;   ///< "left out"

    std::string message() const { return problem + "; " + action; }
};

/// Error of an input of which no triangle is left after repair.
class repair_error : public error
{
public:
    repair_error(const std::string& what, std::vector<repair_finding> findings)
        : error(what), findings_(std::move(findings))
    {
    }

    /// Defects for which all triangles were removed.
    const std::vector<repair_finding>& findings() const noexcept { return findings_; }

private:
    std::vector<repair_finding> findings_;
};

/// Parameters of repair_surface(). Every field has a sensible default.
struct repair_params
{
    /// Weld tolerance: maximum distance of ends of open edges to be welded, to the position of the first of them; in
    /// units of the surface, 0 or more. 0: only equal coordinates. Raise it where edges that should meet agree in few
    /// digits only, to usual_tolerance(). No vertex moves by half of an edge that ends there, so that no edge
    /// vanishes.
    double weld_tolerance = 0;

    /// Normals of the file, or none. They are only compared with the triangles.
    std::span<const vec3> normals = {};
    /// The normals of the corners of each triangle, -1: none; empty: there is one normal per vertex.
    std::span<const std::array<idx, 3>> normal_cells = {};

    /// Body of each vertex, or none: vertices of different bodies are distinct, whatever their coordinates, so that
    /// nothing of one body is stitched to another one or a duplicate of it.
    std::span<const idx> bodies = {};

    /// Polygon of each triangle, or none: triangles of one polygon stay together where edges are separated.
    std::span<const idx> polygons = {};

    /// Weld tolerance for corners that rounding has separated: 1e-7 of the size of the surface, or eight units of the
    /// last digit that coordinates have in the file, single precision or 6 to 12 decimal digits, if these are more; 0
    /// if there is no finite size. At most 1e-3 of the size.
    static double usual_tolerance(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles);

    /// Throws parameter_error. points, triangles: how many the input has
    void validate(std::size_t points, std::size_t triangles) const;
};

/// Result of repair_surface(): a surface, and what was repaired.
struct repaired_surface
{
    using enum repair_kind; // so that a kind of a finding is repaired_surface::degenerate_cell, say

    mesh<triangle> surface;               ///< an oriented manifold of one or more parts, no triangle flat
    std::vector<idx> vertex_origins;      ///< the vertex of the input, one per vertex; of welded ones the smallest
    std::vector<idx> cell_origins;        ///< the triangle of the input, one per triangle, increasing
    std::vector<char> turned;             ///< one per triangle: 1 where corners 1 and 2 have changed places
    std::vector<repair_finding> findings; ///< one per kind, in their order

    /// The corner of triangle cell_origins[c] of the input that corner k of triangle c is.
    std::size_t corner_origin(std::size_t c, std::size_t k) const { return turned[c] != 0 && k > 0 ? 3 - k : k; }
};

/// Repairs a triangle soup to an oriented manifold surface: indices out of range, non-finite coordinates, repeated
/// vertices, degenerate triangles, duplicates, cracks between equal vertices, any winding, non-manifold edges.
/// Triangles keep their order and their places; vertices do (apart from a tolerance), and come in the order of their
/// origins. Repairs are local. O(n log n), the same on any number of threads.
///
/// - Two triangles at an edge of the input stay neighbours. Open edges are stitched to open ones at the same place.
/// - Of duplicates the first stays: of triangles at the same place that face the same way, and of those with the same
///   vertices that face either way.
/// - Neighbours are turned to agree. A closed part whose triangles disagree ends with its normals outward, another as
///   the larger part of its area was. A one-sided part is cut open.
/// - Where three or more triangles meet in an edge, those of one polygon stay together, then pairs that face the same
/// way and bend least stay together, the rest
///   part.
///
/// Throws parameter_error; mesh_error (empty, too_large); repair_error if no triangle is left.
repaired_surface repair_surface(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles,
                                const repair_params& params = {});

} // namespace taut

#endif
#include <taut/impl/leave.inl>
