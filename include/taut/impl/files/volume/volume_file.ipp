// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <iterator>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <taut/certify.hpp>
#include <taut/errors.hpp>
#include <taut/impl/core/mesh/cell_corners.hpp>
#include <taut/impl/core/mesh/describe.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/impl/files/volume/volume_file.hpp>
#include <taut/impl/files/volume/volume_file_bodies.hpp>
#include <taut/volume_file.hpp>

namespace taut::io::impl
{

/// Edge matrix at the corners of a cell whose edges all have length 1, and how much of the simplex there counts so that
/// the cell does as its own measure: 6 volumes of a hexahedron are those of 8 corners, for instance.
inline std::pair<mat2, double> regular_corner(cell_kind kind, triangle)
{
    if (kind == cell_kind::quad) return {mat2(1.0), 0.5};
    return {taut::impl::regular_ideal<triangle>(), 1.0};
}
inline std::pair<mat3, double> regular_corner(cell_kind kind, tetrahedron)
{
    using std::numbers::sqrt2, std::numbers::sqrt3;
    switch (kind)
    {
    case cell_kind::pyramid:
        return {mat3(1, 0, 0, 0, 1, 0, 0.5, 0.5, sqrt2 / 2), 0.5};
    case cell_kind::wedge:
        return {mat3(1, 0, 0, 0.5, sqrt3 / 2, 0, 0, 0, 1), 0.5};
    case cell_kind::hexahedron:
        return {mat3(1.0), 0.75};
    default:
        return {taut::impl::regular_ideal<tetrahedron>(), 1.0};
    }
}

/// Edge matrix of a tetrahedron of the corners of a wedge or hexahedron whose edges all have length 1.
inline mat3 regular_edges(cell_kind kind, const std::array<std::size_t, 4>& corners)
{
    const mat3 W = regular_corner(kind, tetrahedron{}).first;
    const std::size_t floor = kind == cell_kind::wedge ? 3 : 4; // corners
    const auto place = [&](std::size_t corner)
    {
        const std::size_t k = corner % floor;
        const vec3 here = kind == cell_kind::wedge ? vec3(k == 2, k == 1, 0) : vec3(k == 1 || k == 2, k >= 2, 0);
        return W * (here + vec3(0, 0, corner >= floor));
    };
    const vec3 origin = place(corners[0]);
    return {place(corners[1]) - origin, place(corners[2]) - origin, place(corners[3]) - origin};
}

/// Throws io_error unless all cells of the element's dimension are of its kind, mesh_error if there are none.
template <class Element>
mesh<Element> cells_as(const volume_file& file, cell_kind wanted, const std::string& remedy)
{
    std::vector<typename mesh<Element>::cell> cells;
    for_each_cell(file, Element::dimension,
                  [&](cell_kind kind, idx number, std::span<const idx> corners)
                  {
                      if (kind != wanted)
                          throw io_error(file.path,
                                         "cell " + std::to_string(number) + " is a " + shape_of(kind).name + remedy);
                      auto& cell = cells.emplace_back();
                      std::copy_n(corners.begin(), cell.size(), cell.begin());
                  });
    if (cells.empty())
        throw mesh_error(mesh_error::empty, {}, file.path + ": no " + shape_of(wanted).names + "; give a mesh of them");
    return {file.at_rest(), std::move(cells)};
}

inline void require_planar(const volume_file& file)
{
    if (file.dimension != 2)
        throw mesh_error(mesh_error::empty, {},
                         file.path + ": no planar mesh; give one without volume cells, all of whose z are equal");
}

} // namespace taut::io::impl

namespace taut::io
{

const volume_group& volume_file::find_group(std::string_view name) const
{
    const bool number = !name.empty() && name.find_first_not_of("-0123456789") == name.npos;
    const volume_group* found = nullptr;
    std::size_t count = 0;
    for (const auto& g : groups)
    {
        if (g.name == name) return g;
        if (!number || !g.name.ends_with(':' + std::string(name))) continue;
        found = &g;
        ++count;
    }
    if (count == 1) return *found;
    std::string known;
    for (const auto& g : groups) known += (known.empty() ? "" : ", ") + g.name;
    throw group_error(std::string(name), path + ": " + (count > 1 ? "several groups end in '" : "no group '") +
                                             std::string(name) +
                                             (known.empty() ? "'; the file has no groups" : "'; there are " + known));
}

} // namespace taut::io

namespace taut::io::impl
{

void turn_cells(volume_file& file, std::span<const idx> cells)
{
    idx number = 0;
    auto next = cells.begin();
    for (auto& block : file.cells)
    {
        const auto shape = shape_of(block.kind);
        if (shape.dimension != file.dimension) continue;
        const auto n = static_cast<std::size_t>(shape.corners);
        for (std::size_t c = 0; c < block.size(); ++c, ++number)
            if (next != cells.end() && *next == number)
            {
                turn_cell(block.kind, std::span(block.corners).subspan(n * c, n));
                ++next;
            }
    }
    std::vector<idx> turned;
    std::set_symmetric_difference(file.turned.begin(), file.turned.end(), cells.begin(), cells.end(),
                                  std::back_inserter(turned));
    file.turned = std::move(turned);
}

std::string describe_turned(const volume_file& file)
{
    if (file.turned.empty()) return {};
    const auto ids = taut::impl::list_ids("cell", "cells", file.turned);
    return ids + (file.turned.size() == 1 ? " has its" : " have their") + " corners in the other order than " +
           file.format + " files or neighbours have it";
}

} // namespace taut::io::impl

namespace taut::io
{

mesh<tetrahedron> volume_file::tetrahedra() const
{
    return impl::cells_as<tetrahedron>(*this, cell_kind::tetrahedron,
                                       "; this takes tetrahedra alone, split it into such");
}

mesh<triangle> volume_file::triangles() const
{
    impl::require_planar(*this);
    return impl::cells_as<triangle>(*this, cell_kind::triangle, "; this takes triangles alone, split it into such");
}

template <class Element>
impl::corner_simplices<Element> volume_file::corner_simplices(std::span<const idx> edged) const
{
    if constexpr (Element::dimension == 2) impl::require_planar(*this);
    std::vector<typename mesh<Element>::cell> simplices;
    std::vector<idx> cells;
    std::vector<mat<Element::dimension>> regular;
    std::vector<double> weights;
    bool overlapping = false;
    impl::for_each_cell(*this, Element::dimension,
                        [&](cell_kind kind, idx number, std::span<const idx> corners)
                        {
                            const auto regular_one = impl::regular_corner(kind, Element{});
                            const auto table = taut::impl::corner_simplices(corners.size(), Element{});
                            overlapping = overlapping || table.size() > 1;
                            const std::size_t more = std::binary_search(edged.begin(), edged.end(), number)
                                                         ? taut::impl::edge_tetrahedra(corners.size()).size()
                                                         : 0;
                            const double weight =
                                regular_one.second * double(table.size()) / double(table.size() + more);
                            const auto add = [&](const auto& t, const mat<Element::dimension>& edges)
                            {
                                auto& simplex = simplices.emplace_back();
                                for (std::size_t k = 0; k < t.size(); ++k) simplex[k] = corners[t[k]];
                                cells.push_back(number);
                                regular.push_back(edges);
                                weights.push_back(weight);
                            };
                            for (const auto& t : table) add(t, regular_one.first);
                            if constexpr (Element::dimension == 3)
                                for (const auto& t : taut::impl::edge_tetrahedra(corners.size()).first(more))
                                    add(t, impl::regular_edges(kind, t));
                        });
    if (simplices.empty())
        throw mesh_error(mesh_error::empty, {},
                         path + (Element::dimension == 2 ? ": no triangles or quads" : ": no volume cells") +
                             "; give a mesh of them");
    mesh<Element> result(at_rest(), std::move(simplices));
    return {std::move(result), std::move(cells), overlapping, std::move(regular), std::move(weights)};
}

} // namespace taut::io

template taut::io::impl::corner_simplices<taut::tetrahedron>
    taut::io::volume_file::corner_simplices(std::span<const taut::idx>) const;
template taut::io::impl::corner_simplices<taut::triangle>
    taut::io::volume_file::corner_simplices(std::span<const taut::idx>) const;
