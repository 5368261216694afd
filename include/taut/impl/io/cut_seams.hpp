// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <taut/impl/io/surface_file.hpp>
#include <vector>

namespace taut::io
{

/// Surface cut open along the seams of its texture coordinates, so that each vertex has one: the vertices of the file
/// in their order, then a further one for each further sheet of a vertex on a seam. Triangles keep their order.
struct cut_surface
{
    mesh<triangle> surface;
    std::vector<vec2> uv;          ///< of the file, one per vertex; 0 for a vertex without a triangle
    std::vector<idx> origins;      ///< the vertex of the file, one per vertex
    std::vector<idx> corners;      ///< the vertex of each corner of file_faces
    std::size_t seam_vertices = 0; ///< vertices of the file that lie on a seam
};

} // namespace taut::io

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/io/surface/cut_seams.ipp>
#endif
