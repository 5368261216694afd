// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_MESH_HPP
#define TAUT_MESH_HPP

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <vector>

#include <taut/arrays.hpp>
#include <taut/elements.hpp>
#include <taut/impl/core/mesh/arrays.hpp>

/// Meshes of triangles and of tetrahedra: types, arrays, validation, boundaries.
namespace taut
{

/// Mesh at rest: points in space and cells (triangles or tetrahedra) of vertex indices. The points of a planar mesh
/// have one z. It is immutable, and valid for indexing and computing: there is at least one cell, every index is in
/// range, no cell names a vertex twice and every coordinate is finite. Further requirements of a map (disk topology,
/// ...) are checked by validate().
template <class Element>
class mesh
{
public:
    using element = Element;
    static constexpr int dimension = Element::dimension;
    static constexpr int corners = Element::corners;
    using cell = std::array<idx, static_cast<std::size_t>(corners)>;

    /// Makes a mesh. Throws mesh_error: empty, too_large, index_out_of_range, repeated_vertex, non_finite.
    mesh(std::vector<vec3> points, std::vector<cell> cells);

    /// Makes a mesh of arrays of another program, copied once: points of 3 numbers, or of 2 in the plane z = 0; cells
    /// of 32- or 64-bit, signed or unsigned vertex numbers that count from 0.
    ///
    ///     taut::mesh<taut::triangle> m(taut::array_view<const float, 3>(vertices, n, sizeof(my_vertex)),
    ///                                  taut::array_view<const std::uint32_t, 3>(indices, faces));
    template <class Real, int Coordinates, class Index>
        requires(std::floating_point<std::remove_const_t<Real>>&& std::integral<std::remove_const_t<Index>> &&
                 (Coordinates == 2 || Coordinates == 3))
    mesh(const array_view<Real, Coordinates>& points, const array_view<Index, corners>& cells)
        : mesh(impl::points_in_space(points), impl::cells_of_rows(cells))
    {
    }

    // Both arrays are packed: &points()[0].x is 3 doubles per vertex, cells()[0].data() `corners` 32-bit integers per
    // cell (with GLM as it comes; its aligned types have gaps).
    const std::vector<vec3>& points() const noexcept { return points_; } ///< rest positions, one per vertex
    const std::vector<cell>& cells() const noexcept { return cells_; }   ///< vertices of each cell, oriented
    idx vertex_count() const noexcept { return static_cast<idx>(points_.size()); }
    idx cell_count() const noexcept { return static_cast<idx>(cells_.size()); }

    /// Rest positions of the corners of cell c.
    typename Element::rest_corners rest(idx c) const
    {
        const cell& t = cells_[static_cast<std::size_t>(c)];
        typename Element::rest_corners x;
        for (std::size_t k = 0; k < t.size(); ++k) x[k] = points_[static_cast<std::size_t>(t[k])];
        return x;
    }

private:
    void require_sizes() const;

    /// False for a cell that names a vertex twice. Throws mesh_error for one that names no vertex.
    bool is_proper(std::size_t c) const;

    /// Returns whether there is an invalid vertex or cell; the ids are found afterwards.
    bool any_fault() const;

    static bool is_finite(const vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

    void require_cells() const;

    void require_finite() const;

    std::vector<vec3> points_;
    std::vector<cell> cells_;
};

/// Boundary loops as vertex cycles, each with the surface to its left, starting at its smallest vertex; in the order of
/// those. Empty for a closed surface. Around a vertex where two parts of the surface touch, each part has its own loop.
/// Throws mesh_error (non_manifold_facet, inconsistent_orientation) where left has no meaning.
std::vector<std::vector<idx>> boundary_loops(const mesh<triangle>& m);

/// Requirements on a mesh beyond a consistently oriented manifold with non-degenerate cells. The default for triangles
/// is a disk: connected, one boundary loop, no handles.
struct mesh_requirements
{
    bool referenced = true;   ///< every vertex belongs to a cell
    bool connected = true;    ///< one component
    bool open = true;         ///< triangles: there is a boundary
    bool one_boundary = true; ///< triangles: and it is one loop (a component)
    bool no_handles = true;   ///< triangles: and a seam from it to itself cuts the surface apart
};

/// Finds every fault of a mesh, one finding per kind, the most basic first. Empty: the mesh is as required. Boundary
/// and handles are checked where the mesh is an oriented manifold.
template <class Element>
std::vector<mesh_finding> check(const mesh<Element>& m, const mesh_requirements& need = {});

/// Throws the first finding of check() as a mesh_error.
template <class Element>
void validate(const mesh<Element>& m, const mesh_requirements& need = {});

// Compiled once, with the bodies.
extern template class mesh<triangle>;

extern template class mesh<tetrahedron>;

} // namespace taut

#endif
#include <taut/impl/leave.inl>
