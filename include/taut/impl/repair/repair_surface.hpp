// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/mesh/mesh.hpp>
#include <taut/impl/repair/repair_finding.hpp>

namespace taut
{

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

} // namespace taut

namespace taut::impl
{

/// Counts the open edges that repair_surface() would stitch with this tolerance. bodies: as repair_params has them
std::size_t count_near_edges(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles,
                             double weld_tolerance, std::span<const idx> bodies = {});

} // namespace taut::impl

namespace taut
{

/// Result of repair_surface(): a surface, and what was repaired.
struct repaired_surface
{
    using enum impl::repair_kind; // so that a kind of a finding is repaired_surface::degenerate_cell, say

    mesh<triangle> surface;          ///< an oriented manifold of one or more parts, no triangle flat
    std::vector<idx> vertex_origins; ///< the vertex of the input, one per vertex; of welded ones the smallest
    std::vector<idx> cell_origins;   ///< the triangle of the input, one per triangle, increasing
    std::vector<char> turned;        ///< one per triangle: 1 where corners 1 and 2 have changed places
    std::vector<impl::repair_finding> findings; ///< one per kind, in their order

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

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/repair/repair_surface.ipp>
#endif
