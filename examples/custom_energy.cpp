// SPDX-License-Identifier: MIT
// An energy of one's own: ten lines, and the library derives, compiles and minimizes it.
#include <cmath>
#include <iostream>

#include <taut/taut.hpp>

using namespace taut;
using namespace taut::energy;

// [energy]
/// MIPS raised to a power: punishes the worst angles more than the many good ones.
struct mips_power
{
    static constexpr bool barrier = true; // +infinity where det S <= 0
    double p = 2;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        using std::pow;
        return pow(norm2(e.S) / (T(D) * pow(e.det, T(2.0 / D))), T(p));
    }
};
// [energy]

/// A paraboloid over a square, as a grid of n x n quads, two triangles each.
mesh<triangle> bowl(int n)
{
    std::vector<vec3> points;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
        {
            const double x = 2.0 * i / n - 1, y = 2.0 * j / n - 1;
            points.push_back({x, y, x * x + y * y});
        }
    std::vector<mesh<triangle>::cell> cells;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
        {
            const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            cells.push_back({a, b, d});
            cells.push_back({a, d, c});
        }
    return {points, cells};
}

int main()
{
    queue q;
    const auto surface = bowl(40);

    // [use]
    const auto mixed = 0.8 * isometric{} + 0.2 * mips_power{.p = 3};
    if (!check_gradient<2>(mixed)) return 1; // derivative = function? only needed while you write the energy

    auto [uv, report] =
        parameterize(q, surface, {.energy = mixed, .solve = {.stopping = {.gradient_tolerance = 1e-5}}});
    // [use]
    std::cout << report << '\n';
    return report.outcome == outcome::valid ? 0 : 1;
}
