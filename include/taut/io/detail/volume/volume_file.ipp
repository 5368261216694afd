// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/exact/cell_validity.hpp>
#include <taut/io/io_error.hpp>
#include <taut/io/volume_file.hpp>
#include <taut/mesh/ideal.hpp>

namespace taut::io
{

namespace detail
{

/// The corners of the triangles at the corners of a planar cell, counter-clockwise.
inline std::span<const std::array<std::size_t, 3>> corner_table(cell_kind kind, triangle)
{
    using corners = std::array<std::size_t, 3>;
    static constexpr std::array<corners, 1> itself = {{{0, 1, 2}}};
    static constexpr std::array<corners, 4> quad = {{{0, 1, 3}, {1, 2, 0}, {2, 3, 1}, {3, 0, 2}}};
    if (kind == cell_kind::triangle) return itself;
    if (kind == cell_kind::quad) return quad;
    return {};
}

/// The corners of the tetrahedra at the corners of a volume cell, positive.
inline std::span<const std::array<std::size_t, 4>> corner_table(cell_kind kind, tetrahedron)
{
    if (shape_of(kind).dimension < 3) return {};
    return taut::detail::corner_tetrahedra(static_cast<std::size_t>(shape_of(kind).corners));
}

/// Edge matrix at the corners of a cell whose edges all have length 1, and how much of the simplex there counts so that
/// the cell does as its own measure: 6 volumes of a hexahedron are those of 8 corners, for instance.
inline std::pair<mat2, double> regular_corner(cell_kind kind, triangle)
{
    if (kind == cell_kind::quad) return {mat2(1.0), 0.5};
    return {regular_ideal<triangle>(), 1.0};
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
        return {regular_ideal<tetrahedron>(), 1.0};
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

/// How the format of a file has the corners of a cell, in words.
inline std::string convention_of(cell_kind kind, const std::string& format)
{
    switch (kind)
    {
    case cell_kind::pyramid:
        return "corner 4 sees 0, 1, 2, 3 turn counter-clockwise";
    case cell_kind::wedge:
        return format == "VTK" || format == "VTU" || format == "SU2"
                   ? "the normal of corners 0, 1, 2 points away from 3, 4, 5 (these have it as gmsh and MEDIT do)"
                   : "the normal of corners 0, 1, 2 points to 3, 4, 5 (these have it as VTK does)";
    case cell_kind::hexahedron:
        return "corners 4, 5, 6, 7 see 0, 1, 2, 3 turn counter-clockwise";
    case cell_kind::triangle:
    case cell_kind::quad:
        return "corners run counter-clockwise";
    default:
        return "corner 3 sees 0, 1, 2 turn counter-clockwise";
    }
}

/// The shape that the cells of a file have at rest.
inline const std::vector<vec3>& rest_of(const volume_file& file)
{
    return file.rest.empty() ? file.points : file.rest;
}

/// Throws mesh_error if nine of ten cells of a kind, or more, are inverted: then it is the order of their corners.
class orientation_check
{
public:
    explicit orientation_check(const volume_file& file) : file_(file) {}

    /// Of a cell of the element's dimension.
    template <class Element>
    void add(cell_kind kind, idx cell, std::span<const idx> corners)
    {
        const auto& x = rest_of(file_);
        double sum = 0;
        for (const auto& t : corner_table(kind, Element{}))
        {
            typename Element::mapped_corners simplex;
            for (std::size_t k = 0; k < t.size(); ++k)
                simplex[k] = vec<Element::dimension>(x[static_cast<std::size_t>(corners[t[k]])]);
            sum += Element::determinant(simplex);
        }
        auto& of = kinds_[static_cast<std::size_t>(kind)];
        ++of.count;
        if (sum < 0) of.inverted.push_back(cell);
    }

    void finish() const
    {
        for (std::size_t k = 0; k < kinds_.size(); ++k)
        {
            const auto& of = kinds_[k];
            if (of.count == 0 || 10 * of.inverted.size() < 9 * of.count) continue;
            const auto kind = static_cast<cell_kind>(k);
            const bool all = of.inverted.size() == of.count;
            throw mesh_error(mesh_fault::inverted_cell, of.inverted,
                             file_.path + ": " + (all ? "all " : std::to_string(of.inverted.size()) + " of ") +
                                 std::to_string(of.count) + ' ' + shape_of(kind).names + " are turned: in " +
                                 file_.format + " files " + convention_of(kind, file_.format) +
                                 "; write them in this order");
        }
    }

private:
    struct tally
    {
        std::size_t count = 0;
        std::vector<idx> inverted;
    };
    const volume_file& file_;
    std::array<tally, 8> kinds_;
};

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
        throw mesh_error(mesh_fault::empty, {}, file.path + ": no " + shape_of(wanted).names + "; give a mesh of them");
    orientation_check orientation(file);
    for (std::size_t c = 0; c < cells.size(); ++c) orientation.add<Element>(wanted, static_cast<idx>(c), cells[c]);
    mesh<Element> result(rest_of(file), std::move(cells));
    orientation.finish();
    return result;
}

inline void require_planar(const volume_file& file)
{
    if (file.dimension != 2)
        throw mesh_error(mesh_fault::empty, {},
                         file.path + ": no planar mesh; give one without volume cells, all of whose z are equal");
}

} // namespace detail

TAUT_INLINE const volume_group& volume_file::find_group(std::string_view name) const
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

TAUT_ON_USE_BODY mesh<tetrahedron> tetrahedra_of(const volume_file& file)
{
    return detail::cells_as<tetrahedron>(file, cell_kind::tetrahedron,
                                         "; this takes tetrahedra alone, split it into such");
}

TAUT_ON_USE_BODY mesh<triangle> triangles_of(const volume_file& file)
{
    detail::require_planar(file);
    return detail::cells_as<triangle>(file, cell_kind::triangle, "; this takes triangles alone, split it into such");
}

template <class Element>
corner_simplices<Element> corner_simplices_of(const volume_file& file, std::span<const idx> edged)
{
    if constexpr (Element::dimension == 2) detail::require_planar(file);
    std::vector<typename mesh<Element>::cell> simplices;
    std::vector<idx> cells;
    std::vector<mat<Element::dimension>> regular;
    std::vector<double> weights;
    bool overlapping = false;
    detail::orientation_check orientation(file);
    for_each_cell(file, Element::dimension,
                  [&](cell_kind kind, idx number, std::span<const idx> corners)
                  {
                      const auto regular_one = detail::regular_corner(kind, Element{});
                      const auto table = detail::corner_table(kind, Element{});
                      overlapping = overlapping || table.size() > 1;
                      const std::size_t more = std::binary_search(edged.begin(), edged.end(), number)
                                                   ? taut::detail::edge_tetrahedra(corners.size()).size()
                                                   : 0;
                      const double weight = regular_one.second * double(table.size()) / double(table.size() + more);
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
                          for (const auto& t : taut::detail::edge_tetrahedra(corners.size()).first(more))
                              add(t, detail::regular_edges(kind, t));
                      orientation.add<Element>(kind, number, corners);
                  });
    if (simplices.empty())
        throw mesh_error(mesh_fault::empty, {},
                         file.path + (Element::dimension == 2 ? ": no triangles or quads" : ": no volume cells") +
                             "; give a mesh of them");
    mesh<Element> result(detail::rest_of(file), std::move(simplices));
    orientation.finish();
    return {std::move(result), std::move(cells), overlapping, std::move(regular), std::move(weights)};
}

} // namespace taut::io
