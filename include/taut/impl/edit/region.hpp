// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <taut/impl/edit/region_error.hpp>
#include <taut/impl/mesh/mesh.hpp>

namespace taut::impl
{

class face_set;

/// Region of a surface with disk topology, as a mesh of its own.
struct surface_region
{
    mesh<triangle> surface;    ///< the region as a mesh of its own
    std::vector<idx> vertices; ///< vertex v of the region is vertices[v] of the whole surface; increasing
    std::vector<idx> faces;    ///< the same for its triangles
    std::vector<idx> rim;      ///< the boundary loop, in numbers of the region, with the region to its left
};

/// Cuts out triangles. Throws region_error unless they are a disk.
surface_region cut_out(const mesh<triangle>& m, const face_set& set);

/// Throws region_error unless they are from 0 to below `count`.
void require_in_range(std::span<const idx> ids, idx count, const char* thing, const char* things);

} // namespace taut::impl

namespace taut
{

/// Makes a region of these triangles. Throws region_error where it is no disk, mesh_error where the surface is not
/// manifold and oriented.
impl::surface_region region_of_faces(const mesh<triangle>& m, std::span<const idx> faces);

/// Geodesic disk: the triangles around a vertex whose corners are within a geodesic distance of it, in the units of the
/// surface. Enclosed holes are filled where they have fewer triangles than the disk; where the disk touches itself at a
/// vertex, the smaller side is left out; triangles with two sides on the rim are added or removed. Throws as
/// region_of_faces.
impl::surface_region geodesic_disk(const mesh<triangle>& m, idx centre, double radius);

/// Region to the left of a closed loop of edges, named by its vertices in their order. Throws as region_of_faces.
impl::surface_region region_inside(const mesh<triangle>& m, std::span<const idx> loop);

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/edit/region.ipp>
#endif
