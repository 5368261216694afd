// SPDX-License-Identifier: MIT
// Shapes between a plate and the same plate rolled up to a tube: nothing is inverted on the way, and nothing shrinks.
#include <cmath>
#include <iostream>
#include <numbers>

#include <taut/taut.hpp>

using namespace taut;

/// 12 by 1 by 4 cubes of six tetrahedra each.
mesh<tetrahedron> plate()
{
    const int size[] = {12, 1, 4};
    std::vector<vec3> points;
    std::vector<mesh<tetrahedron>::cell> cells;
    const auto at = [&](int i, int j, int k)
    { return static_cast<taut::idx>((k * (size[1] + 1) + j) * (size[0] + 1) + i); };
    for (int k = 0; k <= size[2]; ++k)
        for (int j = 0; j <= size[1]; ++j)
            for (int i = 0; i <= size[0]; ++i) points.emplace_back(i / 2.0, j / 2.0, k / 2.0);
    for (int k = 0; k < size[2]; ++k)
        for (int j = 0; j < size[1]; ++j)
            for (int i = 0; i < size[0]; ++i)
            {
                const taut::idx a = at(i, j, k), b = at(i + 1, j + 1, k + 1);
                const taut::idx ring[] = {at(i + 1, j, k),     at(i + 1, j + 1, k), at(i, j + 1, k),
                                          at(i, j + 1, k + 1), at(i, j, k + 1),     at(i + 1, j, k + 1)};
                for (int s = 0; s < 6; ++s) cells.push_back({a, ring[s], ring[(s + 1) % 6], b}); // around a diagonal
            }
    return {std::move(points), std::move(cells)};
}

int main()
try
{
    queue q;
    const auto flat = plate();
    std::vector<vec3> rolled;
    for (const vec3& p : flat.points())
    {
        const double radius = 1.2 - p.y, angle = 5.5 * p.x / 6; // 315 degrees
        rolled.emplace_back(radius * std::sin(angle), -radius * std::cos(angle), p.z);
    }

    // [between]
    const interpolation<tetrahedron> between(flat, rolled);
    std::size_t inverted = 0;
    for (const double t : {0.25, 0.5, 0.75})
    {
        const auto [x, report] = between.at(q, t); // certified
        inverted += report.flips.flipped;
        std::cout << "t " << t << ": E " << report.energy << '\n'; // 2 where elements are as interpolated
    }
    // [between]
    std::cout << inverted << " inverted, the end is the rolled plate: " << std::boolalpha
              << (between.at(q, 1).x == rolled) << '\n';
}
catch (const error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
