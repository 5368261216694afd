// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include <taut/taut.hpp>

/// nx by ny by nz cubes of an edge length, of six tetrahedra each.
inline taut::mesh<taut::tetrahedron> bar(int nx, int ny, int nz, double edge)
{
    using taut::idx, taut::vec3;
    std::vector<vec3> points;
    std::vector<taut::mesh<taut::tetrahedron>::cell> cells;
    const auto at = [&](int i, int j, int k) { return static_cast<idx>((k * (ny + 1) + j) * (nx + 1) + i); };
    for (int k = 0; k <= nz; ++k)
        for (int j = 0; j <= ny; ++j)
            for (int i = 0; i <= nx; ++i) points.push_back(edge * vec3(i, j, k));
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i)
            {
                const idx a = at(i, j, k), b = at(i + 1, j + 1, k + 1);
                const idx ring[] = {at(i + 1, j, k),     at(i + 1, j + 1, k), at(i, j + 1, k),
                                    at(i, j + 1, k + 1), at(i, j, k + 1),     at(i + 1, j, k + 1)};
                for (int s = 0; s < 6; ++s) cells.push_back({a, ring[s], ring[(s + 1) % 6], b}); // around a diagonal
            }
    return {std::move(points), std::move(cells)};
}
