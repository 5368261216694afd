// SPDX-License-Identifier: MIT
// Prints a map in all its digits: the two files of scripts/amalgamate and the headers give the same.
#ifdef AMALGAMATED
#include "taut.hpp"
#else
#define TAUT_IMPLEMENTATION
#include <taut/parameterize.hpp>
#endif
#include <cmath>
#include <cstdio>
#include <vector>

int main()
{
    constexpr int n = 12;
    std::vector<taut::vec3> points;
    std::vector<taut::mesh<taut::triangle>::cell> cells;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) points.push_back({i, j, 3 * std::sin(0.5 * i) * std::cos(0.4 * j)});
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
        {
            const int a = j * (n + 1) + i, b = a + n + 1;
            cells.push_back({a, a + 1, b + 1});
            cells.push_back({a, b + 1, b});
        }
    taut::queue queue;
    const auto result = taut::parameterize(queue, taut::mesh<taut::triangle>(points, cells));
    for (const auto& p : result.uv) std::printf("%a %a\n", p.x, p.y);
    return result ? 0 : 1;
}
