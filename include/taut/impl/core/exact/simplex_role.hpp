// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <taut/types.hpp>

namespace taut::impl
{

/// Role of a simplex in its cell, in meshes of cells that are no simplices (mesh/cell_corners.hpp). `owners` has the
/// cell of each simplex, those of a cell one after the other.
enum class simplex_role : unsigned char
{
    cell,           ///< all of it
    corner,         ///< that at a corner of the cell, which is its corner 0; the other corners are at the ends of edges
    pyramid_corner, ///< the same at the base of a pyramid, whose apex is corner 3
    edge            ///< a further one, at an edge of a hexahedron or wedge
};

/// Number of corner simplices among the n simplices of a cell, which come first: 8 of a hexahedron also where the 24 at
/// its edges follow, 6 of a wedge where 6 do.
constexpr std::size_t corner_simplex_count(std::size_t n)
{
    return n == 32 ? 8 : n == 12 ? 6 : n;
}

/// The role of each simplex; empty without owners: all are cells.
template <int D>
std::vector<simplex_role> simplex_roles(std::span<const idx> owners)
{
    std::vector<simplex_role> roles(owners.size(), simplex_role::edge);
    for (std::size_t first = 0, last = 0; first < owners.size(); first = last)
    {
        while (last < owners.size() && owners[last] == owners[first]) ++last;
        const std::size_t count = corner_simplex_count(last - first);
        const auto role = count == 1             ? simplex_role::cell
                          : D == 3 && count == 4 ? simplex_role::pyramid_corner
                                                 : simplex_role::corner;
        for (std::size_t s = first; s < first + count; ++s) roles[s] = role;
    }
    return roles;
}

} // namespace taut::impl
