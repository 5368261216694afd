// SPDX-License-Identifier: MIT
#include <cstdio>

#include <taut/taut.hpp>

int cells_of_a_triangle(); // two.cpp: the headers stand in two translation units, so nothing may be defined twice

int main()
{
    std::printf("taut %s, %d cell\n", TAUT_VERSION_STRING, cells_of_a_triangle());
    return cells_of_a_triangle() == 1 ? 0 : 1;
}
