// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>

namespace taut::impl
{

/// The corners of the tetrahedra at the corners of a cell of so many corners, four to eight, positive in VTK's order.
inline std::span<const std::array<std::size_t, 4>> corner_tetrahedra(std::size_t count)
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
    switch (count)
    {
    case 4:
        return tetrahedron;
    case 5:
        return pyramid;
    case 6:
        return wedge;
    case 8:
        return hexahedron;
    default:
        return {};
    }
}

/// The corners of the tetrahedra at the edges of a cell of so many corners, positive where it is regular. The Jacobian
/// determinant is quadratic along an edge, and its middle Bernstein coefficient there is the mean of det of two of
/// them: 24 of a hexahedron, and 6 at the edges of a wedge between its triangles. With those at the corners they are
/// all coefficients of a wedge, and 20 of the 27 of a hexahedron. Of other cells there are none: corners tell.
inline std::span<const std::array<std::size_t, 4>> edge_tetrahedra(std::size_t count)
{
    using corners = std::array<std::size_t, 4>;
    static constexpr std::array<corners, 6> wedge = {
        {{0, 2, 4, 3}, {0, 5, 1, 3}, {1, 0, 5, 4}, {1, 3, 2, 4}, {2, 1, 3, 5}, {2, 4, 0, 5}}};
    static constexpr auto hexahedron = []
    {
        std::array<corners, 24> all{};
        for (std::size_t k = 0; k < 12; ++k)
        {
            const std::size_t axis = k / 4, j = k & 1, i = k >> 1 & 1;
            // The corner in VTK's order at a place along the axis and the two after it.
            const auto at = [axis](std::size_t along, std::size_t second, std::size_t third)
            {
                std::array<std::size_t, 3> c{};
                c[axis] = along, c[(axis + 1) % 3] = second, c[(axis + 2) % 3] = third;
                return 4 * c[2] + (c[1] == 0 ? c[0] : 3 - c[0]);
            };
            const std::size_t a = at(0, i, j), b = at(1, i, j);
            std::array<corners, 2> here = {
                {{a, b, at(0, 1 - i, j), at(1, i, 1 - j)}, {a, b, at(1, 1 - i, j), at(0, i, 1 - j)}}};
            for (std::size_t n = 0; n < 2; ++n)
            {
                if (i != j) std::swap(here[n][2], here[n][3]);
                all[2 * k + n] = here[n];
            }
        }
        return all;
    }();
    if (count == 6) return wedge;
    if (count == 8) return hexahedron;
    return {};
}

} // namespace taut::impl
