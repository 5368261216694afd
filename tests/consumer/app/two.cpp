// SPDX-License-Identifier: MIT
#include <taut/taut.hpp>

int cells_of_a_triangle()
{
    const taut::mesh<taut::triangle> mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    return static_cast<int>(mesh.cells().size());
}
