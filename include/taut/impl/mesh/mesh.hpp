// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <taut/impl/core/parallel.hpp>
#include <taut/impl/mesh/arrays.hpp>
#include <taut/impl/mesh/describe.hpp>
#include <taut/impl/mesh/tetrahedron.hpp>
#include <taut/impl/mesh/triangle.hpp>

namespace taut::impl
{

// Compiled once, with the bodies.
extern template std::string list_first_elements<triangle>(std::size_t, const std::vector<idx>&, std::span<const idx>);
extern template std::string list_first_elements<tetrahedron>(std::size_t, const std::vector<idx>&,
                                                             std::span<const idx>);
extern template mesh_finding describe<triangle>(mesh_error::fault_type, std::vector<idx>, std::span<const idx>);
extern template mesh_finding describe<tetrahedron>(mesh_error::fault_type, std::vector<idx>, std::span<const idx>);

} // namespace taut::impl

namespace taut
{

/// Mesh at rest: points in space and cells (triangles or tetrahedra) of vertex indices. A planar mesh has z = 0.
/// It is immutable, and valid for indexing and computing: there is at least one cell, every index is in range, no cell
/// names a vertex twice and every coordinate is finite. Further requirements of a map (disk topology, ...) are checked
/// by validate().
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

template <class Element>
mesh<Element>::mesh(std::vector<vec3> points, std::vector<cell> cells)
    : points_(std::move(points)), cells_(std::move(cells))
{
    require_sizes();
    if (!any_fault()) return;
    require_cells();
    require_finite();
}

template <class Element>
void mesh<Element>::require_sizes() const
{
    if (cells_.empty()) throw mesh_error(impl::describe<Element>(mesh_error::empty, {}));
    // Corners and facets are numbered cell * corners + k in 32 bits.
    constexpr std::size_t limit = std::numeric_limits<idx>::max();
    if (points_.size() > limit || cells_.size() > limit / static_cast<std::size_t>(corners))
        throw mesh_error(mesh_error::too_large, {},
                         std::to_string(points_.size()) + " vertices and " + std::to_string(cells_.size()) + ' ' +
                             Element::names + " exceed 32-bit numbering; split the mesh");
}

template <class Element>
bool mesh<Element>::is_proper(std::size_t c) const
{
    const idx n = vertex_count();
    const cell& t = cells_[c];
    bool twice = false;
    for (std::size_t k = 0; k < t.size(); ++k)
    {
        if (t[k] < 0 || t[k] >= n)
            throw mesh_error(mesh_error::index_out_of_range, {static_cast<idx>(c), t[k]},
                             std::string(Element::name) + ' ' + std::to_string(c) + ": vertex " + std::to_string(t[k]) +
                                 (t[k] < 0 ? " < 0" : " >= " + std::to_string(n)));
        for (std::size_t j = 0; j < k; ++j) twice = twice || t[j] == t[k];
    }
    return !twice;
}

template <class Element>
bool mesh<Element>::any_fault() const
{
    const auto n = static_cast<std::uint32_t>(vertex_count());
    std::atomic<bool> fault{false};
    impl::parallel_for(cells_.size(),
                       [&](std::size_t begin, std::size_t end)
                       {
                           bool bad = false;
                           for (std::size_t c = begin; c < end; ++c)
                               for (std::size_t k = 0; k < cells_[c].size(); ++k)
                               {
                                   bad |= static_cast<std::uint32_t>(cells_[c][k]) >= n; // negative ones are large
                                   for (std::size_t j = 0; j < k; ++j) bad |= cells_[c][j] == cells_[c][k];
                               }
                           if (bad) fault = true;
                       });
    impl::parallel_for(points_.size(),
                       [&](std::size_t begin, std::size_t end)
                       {
                           bool good = true;
                           for (std::size_t v = begin; v < end; ++v) good &= is_finite(points_[v]);
                           if (!good) fault = true;
                       });
    return fault;
}

template <class Element>
void mesh<Element>::require_cells() const
{
    std::vector<idx> repeated;
    for (std::size_t c = 0; c < cells_.size(); ++c)
        if (!is_proper(c)) repeated.push_back(static_cast<idx>(c));
    if (!repeated.empty()) throw mesh_error(impl::describe<Element>(mesh_error::repeated_vertex, std::move(repeated)));
}

template <class Element>
void mesh<Element>::require_finite() const
{
    std::vector<idx> bad;
    for (std::size_t v = 0; v < points_.size(); ++v)
        if (!is_finite(points_[v])) bad.push_back(static_cast<idx>(v));
    if (!bad.empty()) throw mesh_error(impl::describe<Element>(mesh_error::non_finite, std::move(bad)));
}

// Compiled once, with the bodies.
extern template class mesh<triangle>;
extern template class mesh<tetrahedron>;

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/mesh/mesh.ipp>
#endif
