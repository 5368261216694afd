// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/files/volume/builder.hpp>

namespace taut::io::impl
{

/// Cells along the axes: their corners are in the order of coordinates, not around.
enum : int
{
    vtk_pixel = 8,
    vtk_voxel = 11
};

/// The kind of a cell that VTK (and SU2) gives a number. Throws io_error at `from` for one that is not read.
inline cell_kind kind_of_vtk(long long type, const number_source& from)
{
    static constexpr std::array<std::pair<int, cell_kind>, 10> known = {{{1, cell_kind::vertex},
                                                                         {3, cell_kind::line},
                                                                         {5, cell_kind::triangle},
                                                                         {9, cell_kind::quad},
                                                                         {vtk_pixel, cell_kind::quad},
                                                                         {vtk_voxel, cell_kind::hexahedron},
                                                                         {10, cell_kind::tetrahedron},
                                                                         {14, cell_kind::pyramid},
                                                                         {13, cell_kind::wedge},
                                                                         {12, cell_kind::hexahedron}}};
    for (const auto& [number, kind] : known)
        if (number == type) return kind;
    const std::string_view what =
        type == 42 || type == 41 ? "polyhedra cannot be read; split them into tetrahedra"
        : type > 20              ? "cells of higher order; save the mesh in first order"
                                 : "not a kind of cell that is read; save tetrahedra, pyramids, wedges, hexahedra, "
                                   "triangles, quads, lines and vertices";
    from.fail("cell type " + std::to_string(type) + ": " + std::string(what));
}

/// Cells as VTK's arrays give them: types, and corners of which each cell ends at an offset.
struct vtk_cells
{
    std::vector<int> types;
    std::vector<long long> ends;
    std::vector<idx> corners;

    /// Throws io_error at `from`.
    void move_to(volume_builder& to, const number_source& from)
    {
        if (types.size() != ends.size())
            from.fail(std::to_string(types.size()) + " cell types for " + std::to_string(ends.size()) +
                      " cells; give one each");
        long long begin = 0;
        for (std::size_t c = 0; c < types.size(); ++c)
        {
            const cell_kind kind = kind_of_vtk(types[c], from);
            const long long end = ends[c], needed = begin + shape_of(kind).corners;
            if (end != needed || end > static_cast<long long>(corners.size()))
                from.fail("cell " + std::to_string(c) + ", a " + shape_of(kind).name + ", ends at corner " +
                          std::to_string(end) + " instead of " + std::to_string(needed) + " of " +
                          std::to_string(corners.size()) + "; correct its type or its corners");
            const auto cell =
                std::span(corners).subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
            if (types[c] == vtk_pixel || types[c] == vtk_voxel)
                for (std::size_t k = 2; k < cell.size(); k += 4) std::swap(cell[k], cell[k + 1]);
            to.add_vtk_cell(kind, cell);
            begin = end;
        }
    }
};

/// Makes a group NAME:VALUE of each value of an attribute. One of very many values numbers things, and names nothing.
inline void add_attribute_groups(volume_file& file, const volume_label& a)
{
    constexpr std::size_t most = 256;
    std::set<long long> values;
    for (const long long x : a.values)
        if (values.insert(x).second && values.size() > most)
        {
            file.notes.push_back("'" + a.name + "' has more than " + std::to_string(most) +
                                 " different values; no groups were made of it");
            return;
        }
    tagged_vertices groups;
    if (!a.of_cells)
        for (std::size_t v = 0; v < std::min(a.values.size(), file.points.size()); ++v)
        {
            const auto vertex = static_cast<idx>(v);
            groups.add(a.values[v], 0, {&vertex, 1});
        }
    else
    {
        std::size_t c = 0;
        for (const auto& block : file.cells)
            for (std::size_t i = 0; i < block.size() && c < a.values.size(); ++i, ++c)
                groups.add(a.values[c], shape_of(block.kind).dimension, block.cell(i));
    }
    groups.move_to_prefixed(file, a.name);
}

} // namespace taut::io::impl
