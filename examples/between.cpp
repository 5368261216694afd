// SPDX-License-Identifier: MIT
// Shapes between a plate and the same plate rolled up to a tube: nothing is inverted on the way, and nothing shrinks.
#include <cmath>
#include <iostream>
#include <numbers>

#include <taut/taut.hpp>

#include "bar.hpp"

using namespace taut;

int main()
try
{
    queue q;
    const auto flat = bar(12, 1, 4, 0.5);
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
