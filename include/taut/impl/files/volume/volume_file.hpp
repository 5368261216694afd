// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <taut/impl/files/volume/coding/array_code.hpp>
#include <taut/mesh.hpp>

namespace taut::io::impl
{

struct cell_shape
{
    int dimension;
    int corners;
    const char *name, *names;
};

/// By cell_kind.
inline constexpr std::array<cell_shape, 8> cell_shapes = {{{0, 1, "vertex", "vertices"},
                                                           {1, 2, "line", "lines"},
                                                           {2, 3, "triangle", "triangles"},
                                                           {2, 4, "quad", "quads"},
                                                           {3, 4, "tetrahedron", "tetrahedra"},
                                                           {3, 5, "pyramid", "pyramids"},
                                                           {3, 6, "wedge", "wedges"},
                                                           {3, 8, "hexahedron", "hexahedra"}}};

/// Coordinates that a file has in base64, compressed, or both (VTU): they are written anew together.
struct coded_coordinates
{
    /// An offset of an array that follows them, as the text has it.
    struct later
    {
        std::size_t begin, end; ///< range of its digits
        std::size_t offset;
    };
    impl::array_code code;
    std::size_t begin, end;         ///< range of the code in the file
    std::vector<later> followed_by; ///< ascending by `begin`
};

/// The cells of a file as simplices: tetrahedra, or triangles of a planar file, for themselves; others as the simplices
/// at their corners, which overlap.
template <class Element>
struct corner_simplices
{
    mesh<Element> simplices;                      ///< at rest
    std::vector<idx> cells;                       ///< the cell of each, as for_each_cell() counts
    bool overlapping = false;                     ///< there are cells of other kinds
    std::vector<mat<Element::dimension>> regular; ///< edge matrix of each where its cell has equal edges of length 1
    std::vector<double> weights; ///< weight of each, so that a cell counts once; exact for parallelepipeds
};

} // namespace taut::io::impl
