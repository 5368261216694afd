// SPDX-License-Identifier: MIT
// Shapes of few flat faces: charts without distortion are at hand, and the bound of the mean holds.
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include <taut/impl/atlas/make_atlas.hpp>

using namespace taut;

namespace
{

/// A cube whose faces are cut along one diagonal or the other, by the bits of `cut`.
mesh<triangle> cube(unsigned cut)
{
    std::vector<vec3> p;
    for (int v = 0; v < 8; ++v) p.emplace_back(v & 1, v >> 1 & 1, v >> 2);
    const taut::idx quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    std::vector<std::array<taut::idx, 3>> t;
    for (unsigned f = 0; f < 6; ++f)
    {
        const auto& q = quads[f];
        const unsigned k = cut >> f & 1;
        t.push_back({q[k], q[k + 1], q[k + 2]});
        t.push_back({q[k], q[k + 2], q[(k + 3) % 4]});
    }
    return {std::move(p), std::move(t)};
}

/// A closed prism of n sides, its ends cut as fans.
mesh<triangle> prism(int n, double height)
{
    std::vector<vec3> p;
    for (const double z : {0.0, height})
        for (int k = 0; k < n; ++k)
            p.emplace_back(std::cos(2 * std::numbers::pi * k / n), std::sin(2 * std::numbers::pi * k / n), z);
    std::vector<std::array<taut::idx, 3>> t;
    for (int k = 0; k < n; ++k)
    {
        const int next = (k + 1) % n;
        t.push_back({k, next, n + next});
        t.push_back({k, n + next, n + k});
        if (k > 0 && k + 1 < n)
        {
            t.push_back({0, k + 1, k});
            t.push_back({n, n + k, n + k + 1});
        }
    }
    return {std::move(p), std::move(t)};
}

void check_bound(queue& q, const mesh<triangle>& m, double bound)
{
    atlas_params p;
    p.charts.mean_distortion = bound;
    const auto a = make_atlas(q, m, p);
    REQUIRE(bool(a));
    CHECK(a.report.distortion <= bound);
    CHECK(a.report.charts.size() <= 6);
}

} // namespace

TEST_CASE("make_atlas: cubes and prisms keep the bound, however they are cut and however tight it is")
{
    queue q;
    for (unsigned cut = 0; cut < 64; cut += 3)
    {
        CAPTURE(cut);
        check_bound(q, cube(cut), 4.1);
    }
    for (const int sides : {6, 8, 48})
        for (const double height : {0.2, 3.0})
            for (const double bound : {4.1, 4.02, 4.004})
            {
                CAPTURE(sides);
                CAPTURE(height);
                check_bound(q, prism(sides, height), bound);
            }
}

TEST_CASE("make_atlas: copies that lie on each other have the least distorted of their maps")
{
    queue q;
    const auto one = cube(63);
    auto points = one.points();
    auto cells = one.cells();
    for (const vec3& x : one.points()) points.push_back(x + vec3(3, 0, 0));
    for (const auto& t : one.cells()) cells.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
    atlas_params p{.stack = true};
    const auto a = make_atlas(q, mesh<triangle>(std::move(points), std::move(cells)), p);
    REQUIRE(bool(a));
    CHECK(a.report.stacked > 0);
    CHECK(a.report.distortion <= 4.1);
}
