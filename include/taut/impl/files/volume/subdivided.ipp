// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/files/volume/formats.hpp>
#include <taut/impl/files/volume/plain_mesh.hpp>
#include <taut/impl/files/volume/read_volume.hpp>
#include <taut/impl/files/volume/volume_file_bodies.hpp>
#include <taut/impl/files/volume/write_volume.hpp>
#include <taut/volume_file.hpp>

namespace taut::io::impl
{

/// Adds the parts of the cells of a block, and their labels behind the ones that there are.
template <std::size_t N>
void add_parts(const cell_block& block, const taut::impl::subdivision& how, cell_block& to, std::vector<idx>& of,
               idx number)
{
    for (std::size_t c = 0; c < block.size(); ++c, ++number)
    {
        std::array<idx, N> cell{};
        std::copy_n(block.cell(c).begin(), N, cell.begin());
        how.for_each_part(cell,
                          [&](const std::array<idx, N>& part)
                          {
                              to.corners.insert(to.corners.end(), part.begin(), part.end());
                              of.push_back(number);
                          });
    }
}

inline plain_mesh plain_subdivided(const volume_file& file, const taut::impl::subdivision& how)
{
    plain_mesh m{file, how.extended(std::span<const vec3>(file.points)), {}, {}, {}, {}};
    if (!file.rest.empty()) m.rest = how.extended(std::span<const vec3>(file.rest));
    std::vector<idx> of;                 // of each part, its cell
    idx number = 0, cells = 0, part = 0; // of all cells; of those of the file's dimension, and of their parts
    for (const auto& block : file.cells)
    {
        m.cells.push_back({block.kind, {}});
        switch (block.kind)
        {
        case cell_kind::vertex:
            add_parts<1>(block, how, m.cells.back(), of, number);
            break;
        case cell_kind::line:
            add_parts<2>(block, how, m.cells.back(), of, number);
            break;
        case cell_kind::triangle:
            add_parts<3>(block, how, m.cells.back(), of, number);
            break;
        case cell_kind::tetrahedron:
            add_parts<4>(block, how, m.cells.back(), of, number);
            break;
        default:
            throw io_error(file.path, std::string("has ") + shape_of(block.kind).names +
                                          ", and only lines, triangles and tetrahedra can be split; triangulate them");
        }
        if (shape_of(block.kind).dimension == file.dimension)
        {
            auto& parts = m.cells.back();
            const std::size_t before = of.size() - parts.size(),
                              n = static_cast<std::size_t>(shape_of(block.kind).corners);
            for (std::size_t p = 0; p < parts.size(); ++p, ++part)
            {
                const idx cell = of[before + p] - number + cells; // as file.turned counts
                if (!std::binary_search(file.turned.begin(), file.turned.end(), cell)) continue;
                turn_cell(block.kind, std::span(parts.corners).subspan(n * p, n));
                m.turned.push_back(part);
            }
            cells += static_cast<idx>(block.size());
        }
        number += static_cast<idx>(block.size());
    }
    for (const auto& label : file.labels)
    {
        volume_label all{label.name, label.of_cells, {}};
        if (label.of_cells)
            for (const idx c : of) all.values.push_back(value_or_0(label.values, static_cast<std::size_t>(c)));
        else
        {
            all.values = label.values;
            all.values.resize(file.points.size(), 0);
            for (const auto& simplex : how.middles())
            {
                const auto value = [&](idx v) { return all.values[static_cast<std::size_t>(v)]; };
                const bool same = std::all_of(simplex.begin(), simplex.end(),
                                              [&](idx v) { return value(v) == value(simplex.front()); });
                all.values.push_back(same ? value(simplex.front()) : 0);
            }
        }
        m.labels.push_back(std::move(all));
    }
    return m;
}

volume_file subdivided(const volume_file& file, const taut::impl::subdivision& how)
{
    if (static_cast<std::size_t>(how.original_count()) != file.points.size())
        throw parameter_error("how", "is of " + std::to_string(how.original_count()) + " points, and the file has " +
                                         std::to_string(file.points.size()));
    const auto as = std::find_if(text_formats.begin(), text_formats.end(),
                                 [&](const text_format& f) { return name_of(f.format) == file.format; });
    if (as == text_formats.end())
        throw io_error(file.path, "a refined mesh of the format " + file.format +
                                      " is not written; convert it to MEDIT, gmsh, VTK or VTU");
    auto mesh = plain_subdivided(file, how);
    auto result = parse_volume(as->text(mesh), as->format, file.path);
    std::vector<idx> differing; // the order of a cell is that of its parts, whatever a reader makes of these
    std::set_symmetric_difference(result.turned.begin(), result.turned.end(), mesh.turned.begin(), mesh.turned.end(),
                                  std::back_inserter(differing));
    turn_cells(result, differing);
    if (result.rest.empty()) result.rest = std::move(mesh.rest);
    result.notes.push_back("cells were split: the file is written anew, without comments and without data other "
                           "than references, tags and integer arrays");
    return result;
}

} // namespace taut::io::impl
