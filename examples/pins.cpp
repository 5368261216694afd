// SPDX-License-Identifier: MIT
// Hard and soft constraints: a boundary on a letter, pinned vertices inside, a spring, and no fold.
#include <cmath>
#include <iostream>
#include <numbers>

#include <taut/taut.hpp>

using namespace taut;

/// A wavy disk of n rings: vertex 0 is its centre, ring r has 6 r vertices, the last one is the boundary.
mesh<triangle> wavy_disk(int n)
{
    std::vector<vec3> points{vec3(0.0)};
    std::vector<mesh<triangle>::cell> cells;
    int inner = 0;
    for (int r = 1; r <= n; ++r)
    {
        const int outer = static_cast<int>(points.size()), m = 6 * r, k = 6 * (r - 1);
        for (int i = 0; i < m; ++i)
        {
            const double a = 2 * std::numbers::pi * i / m, x = std::cos(a) * r / n, y = std::sin(a) * r / n;
            points.push_back({x, y, 0.2 * std::sin(5 * x) * std::cos(4 * y)});
        }
        for (int s = 0; s < 6; ++s)
            for (int i = 0; i < r; ++i)
            {
                const int a = outer + (s * r + i) % m, b = outer + (s * r + i + 1) % m;
                const int c = k == 0 ? inner : inner + (s * (r - 1) + i) % k;
                cells.push_back({a, b, c});
                if (i + 1 < r) cells.push_back({b, inner + (s * (r - 1) + i + 1) % k, c});
            }
        inner = outer;
    }
    return {points, cells};
}

int main()
{
    queue q;
    const auto surface = wavy_disk(20);

    // [pins]
    // The boundary goes around a letter L; a vertex is pinned, another has its u fixed, a third is pulled by a spring.
    auto wanted = taut::constraints(surface);
    wanted.pin_boundary(std::vector<vec2>{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}});
    wanted.pin(0, {0.4, 0.6}).pin_u(40, 0.7).spring(100, {0.5, 0.5}, 10.0);

    auto result = parameterize(q, surface, {.constraints = wanted});
    if (!result)
    {
        std::cerr << result.reason() << '\n'; // infeasible, and which triangles prove it; or how many are left inverted
        return 1;
    }
    const bool exact = result.uv[0] == vec2(0.4, 0.6) && result.uv[40].x == 0.7; // bit for bit
    // [pins]
    std::cout << result.report << ", pins " << (exact ? "exact" : "moved") << '\n';
    return exact ? 0 : 1;
}
