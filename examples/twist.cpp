// SPDX-License-Identifier: MIT
// A bar of tetrahedra is twisted by half a turn: its ends are held, what is between follows, and nothing is inverted.
#include <iostream>
#include <numbers>

#include <taut/taut.hpp>

using namespace taut;

/// n by n by 4 n cubes of six tetrahedra each.
mesh<tetrahedron> bar(int n)
{
    std::vector<vec3> points;
    std::vector<mesh<tetrahedron>::cell> cells;
    const auto at = [n](int i, int j, int k) { return static_cast<taut::idx>((k * (n + 1) + j) * (n + 1) + i); };
    for (int k = 0; k <= 4 * n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) points.push_back(vec3(i, j, k) / double(n));
    for (int k = 0; k < 4 * n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
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
    const auto volume = bar(6);
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
    std::cout << "E " << report.energy << (report.converged ? ", converged, " : ", ") << report.flips.flipped << " of "
              << report.flips.elements << " inverted\n";
    // [twist]
    return report.outcome == outcome::valid ? 0 : 1;
}
catch (const error& e)
{
    std::cerr << e.what() << '\n';
    return 1;
}
