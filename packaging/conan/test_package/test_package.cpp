// SPDX-License-Identifier: MIT
#include <cstdio>

#include <taut/taut.hpp>

int main()
{
    const taut::mesh<taut::triangle> mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    std::printf("taut %s, %d triangle, %zu devices\n", TAUT_VERSION_STRING, int(mesh.cell_count()),
                taut::devices().size());
}
