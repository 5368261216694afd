// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/io/io_error.hpp>
#include <taut/io/volume_file.hpp>

namespace taut::io
{

namespace detail
{

/// The corners of the tetrahedra at the corners of a cell, positive in VTK's order.
inline std::span<const std::array<std::size_t, 4>> corner_table(cell_kind kind)
{
    using corners = std::array<std::size_t, 4>;
    static constexpr std::array<corners, 1> tetrahedron = {{{0, 1, 2, 3}}};
    static constexpr std::array<corners, 4> pyramid = {{{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}}};
    static constexpr std::array<corners, 6> wedge = {
        {{0, 2, 1, 3}, {1, 0, 2, 4}, {2, 1, 0, 5}, {3, 4, 5, 0}, {4, 5, 3, 1}, {5, 3, 4, 2}}};
    static constexpr std::array<corners, 8> hexahedron = {{{0, 1, 3, 4},
                                                           {1, 2, 0, 5},
                                                           {2, 3, 1, 6},
                                                           {3, 0, 2, 7},
                                                           {4, 7, 5, 0},
                                                           {5, 4, 6, 1},
                                                           {6, 5, 7, 2},
                                                           {7, 6, 4, 3}}};
    switch (kind)
    {
    case cell_kind::tetrahedron:
        return tetrahedron;
    case cell_kind::pyramid:
        return pyramid;
    case cell_kind::wedge:
        return wedge;
    case cell_kind::hexahedron:
        return hexahedron;
    default:
        return {};
    }
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

    void add(cell_kind kind, idx cell, std::span<const idx> corners)
    {
        const auto& x = rest_of(file_);
        const auto point = [&](std::size_t k) { return x[static_cast<std::size_t>(corners[k])]; };
        double sum = 0;
        for (const auto& t : corner_table(kind))
            sum += tetrahedron::determinant({point(t[0]), point(t[1]), point(t[2]), point(t[3])});
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

/// Calls f(kind, number, corners) for each cell of the file; number: counted over all kinds.
template <class F>
void for_each_cell(const volume_file& file, const F& f)
{
    idx number = 0;
    for (const auto& block : file.cells)
        for (std::size_t c = 0; c < block.size(); ++c) f(block.kind, number++, block.cell(c));
}

/// Throws io_error unless all cells of the element's dimension are of its kind, mesh_error if there are none.
template <class Element>
mesh<Element> cells_as(const volume_file& file, cell_kind wanted, const std::string& remedy)
{
    std::vector<typename mesh<Element>::cell> cells;
    for_each_cell(file,
                  [&](cell_kind kind, idx number, std::span<const idx> corners)
                  {
                      if (shape_of(kind).dimension != Element::dimension) return;
                      if (kind != wanted)
                          throw io_error(file.path,
                                         "cell " + std::to_string(number) + " is a " + shape_of(kind).name + remedy);
                      auto& cell = cells.emplace_back();
                      std::copy_n(corners.begin(), cell.size(), cell.begin());
                  });
    if (cells.empty())
        throw mesh_error(mesh_fault::empty, {}, file.path + ": no " + shape_of(wanted).names + "; give a mesh of them");
    return mesh<Element>(rest_of(file), std::move(cells));
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

TAUT_INLINE mesh<tetrahedron> tetrahedra_of(const volume_file& file)
{
    auto result = detail::cells_as<tetrahedron>(file, cell_kind::tetrahedron,
                                                "; this takes tetrahedra alone, split it into such");
    detail::orientation_check orientation(file);
    for (idx c = 0; c < result.cell_count(); ++c)
        orientation.add(cell_kind::tetrahedron, c, result.cells()[static_cast<std::size_t>(c)]);
    orientation.finish();
    return result;
}

TAUT_INLINE mesh<triangle> triangles_of(const volume_file& file)
{
    if (file.dimension != 2)
        throw mesh_error(mesh_fault::empty, {},
                         file.path + ": no planar mesh; give one without volume cells, all of "
                                     "whose z are equal");
    return detail::cells_as<triangle>(file, cell_kind::triangle, "; this takes triangles alone, split it into such");
}

TAUT_INLINE corner_simplices corner_simplices_of(const volume_file& file)
{
    std::vector<mesh<tetrahedron>::cell> simplices;
    std::vector<idx> cells;
    detail::orientation_check orientation(file);
    detail::for_each_cell(file,
                          [&](cell_kind kind, idx number, std::span<const idx> corners)
                          {
                              for (const auto& t : detail::corner_table(kind))
                              {
                                  simplices.push_back({corners[t[0]], corners[t[1]], corners[t[2]], corners[t[3]]});
                                  cells.push_back(number);
                              }
                              if (shape_of(kind).dimension == 3) orientation.add(kind, number, corners);
                          });
    if (simplices.empty())
        throw mesh_error(mesh_fault::empty, {}, file.path + ": no volume cells; give a mesh of them");
    orientation.finish();
    return {mesh<tetrahedron>(detail::rest_of(file), std::move(simplices)), std::move(cells)};
}

} // namespace taut::io
