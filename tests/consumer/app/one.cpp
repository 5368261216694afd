// SPDX-License-Identifier: MIT
#include <cstdio>

#include <taut/taut.hpp>

int cells_of_a_triangle(); // two.cpp: the headers stand in two translation units, so nothing may be defined twice

int main()
{
    std::printf("taut %s, %d cell, %zu devices\n", TAUT_VERSION_STRING, cells_of_a_triangle(), taut::devices().size());
    try
    {
        taut::io::read_surface("nowhere.obj");
        return 1;
    }
    catch (const taut::error& e)
    {
        std::printf("%s\n", e.what());
    }
    return cells_of_a_triangle() == 1 ? 0 : 1;
}
