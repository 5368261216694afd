// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/mesh/describe.hpp>
#include <taut/impl/core/mesh/facets.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/impl/core/mesh/layout.hpp>
#include <taut/mesh.hpp>

namespace taut
{

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
                             std::string(Element::name) + ' ' + std::to_string(c) + " has vertex " +
                                 std::to_string(t[k]) + "; there are " + std::to_string(n) + ", numbered from 0");
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

} // namespace taut

namespace taut::impl
{

template std::string list_first_elements<triangle>(std::size_t, const std::vector<idx>&, std::span<const idx>);
template std::string list_first_elements<tetrahedron>(std::size_t, const std::vector<idx>&, std::span<const idx>);
template mesh_finding describe<triangle>(mesh_error::fault_type, std::vector<idx>, std::span<const idx>);
template mesh_finding describe<tetrahedron>(mesh_error::fault_type, std::vector<idx>, std::span<const idx>);

} // namespace taut::impl

namespace taut
{

template class mesh<triangle>;
template class mesh<tetrahedron>;

} // namespace taut

namespace taut::impl
{

template facet_table facets(const mesh<triangle>&);
template facet_table facets(const mesh<tetrahedron>&);
template std::pair<std::vector<idx>, std::vector<idx>> bad_rest_cells(const mesh<triangle>&);
template std::pair<std::vector<idx>, std::vector<idx>> bad_rest_cells(const mesh<tetrahedron>&);
template struct ideal_elements<triangle>;
template struct ideal_elements<tetrahedron>;
template csr vertex_corners(const mesh<triangle>&);
template csr vertex_neighbours(const mesh<triangle>&);
template csr vertex_corners(const mesh<tetrahedron>&);
template csr vertex_neighbours(const mesh<tetrahedron>&);
template struct layout<triangle>;
template struct layout<tetrahedron>;

} // namespace taut::impl
