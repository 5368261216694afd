// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include <taut/volume_file.hpp>

namespace taut::io::impl
{

/// Puts the corners of a cell in the other order: it is mirrored. Twice is nothing.
inline void turn_cell(cell_kind kind, std::span<idx> corners)
{
    switch (kind)
    {
    case cell_kind::triangle:
    case cell_kind::tetrahedron:
        return std::swap(corners[1], corners[2]);
    case cell_kind::wedge:
        std::swap(corners[4], corners[5]);
        return std::swap(corners[1], corners[2]);
    case cell_kind::hexahedron:
        std::swap(corners[5], corners[7]);
        return std::swap(corners[1], corners[3]);
    case cell_kind::quad:
    case cell_kind::pyramid:
        return std::swap(corners[1], corners[3]);
    case cell_kind::vertex:
    case cell_kind::line:
        return;
    }
}

/// Calls f(kind, number, corners) for each cell of the file of this dimension, in the order of the file; number:
/// counted over them, all kinds together, from 0.
template <class F>
void for_each_cell(const volume_file& file, int dimension, const F& f)
{
    idx number = 0;
    for (const auto& block : file.cells)
        if (shape_of(block.kind).dimension == dimension)
            for (std::size_t c = 0; c < block.size(); ++c) f(block.kind, number++, block.cell(c));
}

/// Puts the corners of cells of the file's dimension, ascending, in the other order, and says so in `turned`.
void turn_cells(volume_file& file, std::span<const idx> cells);

/// "12 cells (3, 5, ...) have their corners in the other order than ...": of `turned`; empty: there are none.
std::string describe_turned(const volume_file& file);

} // namespace taut::io::impl
