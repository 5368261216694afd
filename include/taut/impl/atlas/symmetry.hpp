// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/csr.hpp>
#include <taut/impl/core/error.hpp>
#include <taut/impl/mesh/facets.hpp>

namespace taut
{

/// Error of a surface that is not its own mirror image. what() says which vertices have none in the best plane.
class symmetry_error : public error
{
public:
    /// edges: true if all vertices have images, but edges of these have none
    symmetry_error(const vec3& normal, double offset, std::vector<idx> vertices, bool edges)
        : error(message(normal, offset, vertices, edges)),
          normal_(normal),
          offset_(offset),
          vertices_(std::move(vertices)),
          edges_(edges)
    {
    }

    const vec3& normal() const noexcept { return normal_; }
    double offset() const noexcept { return offset_; }
    const std::vector<idx>& vertices() const noexcept { return vertices_; } ///< ascending
    bool edges() const noexcept { return edges_; }

private:
    static std::string message(const vec3& normal, double offset, const std::vector<idx>& vertices, bool edges);

    vec3 normal_;
    double offset_;
    std::vector<idx> vertices_;
    bool edges_;
};

} // namespace taut

namespace taut::impl
{

/// Plane of symmetry of a surface, vertex by vertex and polygon by polygon.
struct mirror_symmetry
{
    vec3 normal{0.0};  ///< unit normal of the plane
    double offset = 0; ///< the plane has the points x with dot(normal, x) = offset

    std::vector<idx> vertex;  ///< the image of each vertex; itself on the plane
    std::vector<idx> side;    ///< the image of each side, which runs the other way; -1 within polygons
    std::vector<idx> polygon; ///< polygon of each triangle, by the first of its triangles
    impl::csr triangles;      ///< triangles of each polygon
    std::vector<idx> image;   ///< image of each polygon: itself where it lies across the plane

    /// The corner at the image of the vertex of corner k of triangle c, in the image of its polygon. Triangles need not
    /// have images, as a polygon and its image may be cut along other diagonals.
    idx corner(const mesh<triangle>& m, idx c, idx k) const
    {
        const auto u = [](idx i) { return static_cast<std::size_t>(i); };
        const idx v = vertex[u(m.cells()[u(c)][u(k)])];
        for (const idx t : triangles.row(image[u(polygon[u(c)])]))
            for (idx j = 0; j < 3; ++j)
                if (m.cells()[u(t)][u(j)] == v) return 3 * t + j;
        return -1; // never: polygons and their images have the same sides
    }
};

} // namespace taut::impl

namespace taut
{

/// Finds a plane in which a surface is its own mirror image.
/// together:  diagonals of polygons, as in segment_params: they need no images
/// tolerance: maximum distance of a vertex from the image of another one, relative to the diagonal of the box
/// Throws symmetry_error if there is none.
impl::mirror_symmetry find_symmetry(const mesh<triangle>& m, const impl::facet_table& f,
                                    std::span<const char> together = {}, double tolerance = 1e-4);
inline impl::mirror_symmetry find_symmetry(const mesh<triangle>& m, std::span<const char> together = {},
                                           double tolerance = 1e-4)
{
    return find_symmetry(m, impl::facets(m), together, tolerance);
}

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/atlas/symmetry/find_symmetry.ipp>
#endif
