// SPDX-License-Identifier: MIT
// A bar of tetrahedra is twisted by half a turn: its ends are held, what is between follows, and nothing is inverted.
#include <iostream>
#include <numbers>

#include <taut/taut.hpp>

#include "bar.hpp"

using namespace taut;

int main()
try
{
    queue q;
    const auto volume = bar(6, 6, 24, 1.0 / 6);
    std::vector<taut::idx> bottom, top;
    for (taut::idx v = 0; v < volume.vertex_count(); ++v)
    {
        const double z = volume.points()[static_cast<std::size_t>(v)].z;
        if (z == 0) bottom.push_back(v);
        if (z == 4) top.push_back(v);
    }

    // [twist]
    const auto half_turn = [](const vec3& p) { return vec3(1 - p.x, 1 - p.y, p.z + 0.5); };
    deform_params<tetrahedron> params;
    params.constraints = constraints(volume).fix(bottom).move(top, half_turn);
    const auto [x, report] = deform(q, volume, params); // certified: no tetrahedron is inverted
    std::cout << report << '\n';
    // [twist]
    return report.outcome == outcome::valid ? 0 : 1;
}
catch (const error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
