// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/winding.hpp>
#include <taut/certify.hpp>
#include <taut/impl/core/measure/describe_defects.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;

/// A closed fan of n triangles around vertex 0 whose rim winds `times` about it, turned by `phase`.
std::vector<vec2> wound_fan(int n, int times, double phase = 0)
{
    std::vector<vec2> uv{vec2(0.0)};
    for (int k = 0; k < n; ++k)
    {
        const double angle = phase + 2 * std::numbers::pi * times * k / n;
        uv.emplace_back(std::cos(angle), std::sin(angle));
    }
    return uv;
}

} // namespace

TEST_CASE("branch points: a fan that winds more than once around its centre has one, in any position")
{
    for (const int n : {12, 13, 40})
    {
        const auto m = test::fan(n, true);
        for (int step = 0; step < 24; ++step)
        {
            const double phase = std::numbers::pi * step / 12; // corners on the axes, too
            CHECK(branch_points(m.cells(), wound_fan(n, 1, phase)).empty());
            CHECK(branch_points(m.cells(), wound_fan(n, 2, phase)) == std::vector<idx>{0});
            CHECK(branch_points(m.cells(), wound_fan(n, 3, phase)) == std::vector<idx>{0});
            auto mirrored = wound_fan(n, 2, phase);
            for (vec2& p : mirrored) p.x = -p.x;
            CHECK(branch_points(m.cells(), mirrored) == std::vector<idx>{0});
        }
    }
}

TEST_CASE("branch points: a vertex on the boundary is none, however far its triangles turn")
{
    const auto m = test::fan(12, false);
    auto uv = wound_fan(13, 2);
    CHECK(branch_points(m.cells(), uv).empty());
    CHECK(static_cast<bool>(certify<2>(m.cells(), uv)));
}

TEST_CASE("branch points: two fans that touch in a vertex wind once each")
{
    auto cells = test::fan(6, true).cells();
    for (std::size_t k = 0; k < 6; ++k)
    {
        auto second = cells[k];
        for (idx& v : second)
            if (v != 0) v += 6;
        cells.push_back(second);
    }
    auto uv = wound_fan(6, 1);
    const auto again = wound_fan(6, 1, 0.3);
    uv.insert(uv.end(), again.begin() + 1, again.end());
    CHECK(branch_points(cells, uv).empty());
}

TEST_CASE("branch points: where triangles differ in orientation, flips are what is told")
{
    const auto m = test::fan(12, true);
    auto uv = wound_fan(12, 2);
    std::swap(uv[1], uv[2]);
    const auto c = certify<2>(m.cells(), uv);
    CHECK(c.flipped > 0);
    CHECK(c.branched == 0);
}

TEST_CASE("branch points: exact where the triangles are slivers")
{
    // The rim lies within a few units in the last place of a line through the centre.
    const double e = std::ldexp(1.0, -52);
    std::vector<vec2> once{{0, 0}, {1, e}, {-1, 2 * e}, {-1, -e}, {1, -2 * e}};
    const auto around = test::fan(4, true);
    REQUIRE(certify<2>(around.cells(), once).flipped == 0);
    CHECK(branch_points(around.cells(), once).empty());
    std::vector<vec2> twice = once;
    twice.insert(twice.end(), once.begin() + 1, once.end());
    const auto m = test::fan(8, true);
    REQUIRE(certify<2>(m.cells(), twice).flipped == 0);
    CHECK(branch_points(m.cells(), twice) == std::vector<idx>{0});
}

TEST_CASE("branch points: those of a power of z on a grid, as angles find them")
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> anywhere(-0.35, 0.35);
    for (int k = 0; k < 30; ++k)
    {
        // z -> (z - a)(z - b) has its branch point at (a + b) / 2.
        const auto m = test::grid(24, 24);
        const vec2 a(anywhere(random), anywhere(random)), b(anywhere(random), anywhere(random));
        std::vector<vec2> uv;
        for (const auto& p : m.points())
        {
            const vec2 z = vec2(p.x, p.y) - vec2(0.5) - a, w = vec2(p.x, p.y) - vec2(0.5) - b;
            uv.emplace_back(z.x * w.x - z.y * w.y, z.x * w.y + z.y * w.x);
        }
        const auto c = certify<2>(m.cells(), uv);
        CHECK(c.branch_ids == test::wound_vertices(m, uv));
        CHECK_FALSE(static_cast<bool>(c)); // flipped around the zero of the derivative, or a branch point there
    }
}

TEST_CASE("certificate: defects are described with their first ids")
{
    certificate c;
    CHECK(describe_defects<triangle>(c) == "no defect");
    c.branched = 1;
    c.branch_ids = {7};
    CHECK(describe_defects<triangle>(c) == "1 vertex (7) that the map winds around more than once");
    c.flipped = 20;
    c.ids = {1, 2, 3, 4, 5, 6};
    CHECK(describe_defects<triangle>(c) ==
          "20 triangles (1, 2, 3, 4, 5, ...) flipped, and 1 vertex (7) that the map winds around more than once");
}
