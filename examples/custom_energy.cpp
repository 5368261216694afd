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

// [plane]
/// As rigid as possible, for triangles alone: |S - R|^2 with R the rotation that is nearest to S, and a barrier where S
/// shrinks.
struct rigid
{
    static constexpr bool barrier = true;

    template <class T>
    T operator()(const element<T, 2>& e) const
    {
        using std::log, std::sqrt;
        const T square = norm2(e.S);
        const T away = square - 2.0 * sqrt(square + 2.0 * e.det) + 2.0;
        return away + select(e.det < T(1), e.det - 1.0 - log(e.det), T(0));
    }
};
// [plane]

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
    if (const auto found = check_gradient<2>(mixed); !found) // only needed while you write the energy
    {
        std::cerr << found << '\n'; // which check failed, and how
        return 1;
    }

    auto [uv, report] = parameterize(q, surface, {.energy = mixed, .solve = {.gradient_tolerance = 1e-5}});
    // [use]
    const auto stiff = parameterize(q, surface, {.energy = rigid{}});
    if (!check_gradient<2>(rigid{}) || !stiff) return 1;
    std::cout << "rigid: " << stiff.report << '\n' << report << '\n';
    return report.outcome == outcome::valid ? 0 : 1;
}
