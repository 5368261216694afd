// SPDX-License-Identifier: MIT
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include <support/closed_meshes.hpp>
#include <taut/impl/charts/atlas/seams/openness.hpp>
#include <taut/impl/charts/atlas/seams/seam_factors.hpp>

using namespace taut;

TEST_CASE("vertex_openness: all of a convex surface is seen, the ground of a shaft is not")
{
    const auto ball = test::ball(6);
    for (const double x : impl::vertex_openness(ball)) CHECK(x == 1);
    // A box with a shaft of 1 x 1 x 3 from above.
    std::set<test::cube_cell> filled;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 4; ++k)
                if (i != 1 || j != 1 || k == 0) filled.insert({i, j, k});
    const auto shaft = test::cubes(filled, 2);
    const auto open = impl::vertex_openness(shaft);
    int ground = 0, outside = 0;
    for (std::size_t v = 0; v < open.size(); ++v)
    {
        const vec3& x = shaft.points()[v];
        const bool inner = x.x > 1.1 && x.x < 1.9 && x.y > 1.1 && x.y < 1.9;
        if (inner && std::abs(x.z - 1) < 0.1)
        {
            CHECK(open[v] < 0.2);
            ++ground;
        }
        if (x.x < 0.1 && x.z > 0.1 && x.z < 3.9 && x.y > 0.1 && x.y < 2.9)
        {
            CHECK(open[v] == 1);
            ++outside;
        }
    }
    CHECK(ground > 0);
    CHECK(outside > 0);
}

TEST_CASE("seam_factors: hollows, concave creases and weights, the same on both sides")
{
    std::set<test::cube_cell> filled{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}; // an L
    const auto m = test::cubes(filled, 3);
    const auto f = taut::impl::facets(m);
    const auto open = impl::vertex_openness(m);
    const auto creased = impl::seam_factors(m, f, {.crease_angle = 60}, {});
    const auto hidden = impl::seam_factors(m, f, {.hide = 1}, open);
    std::size_t concave = 0, convex = 0;
    for (std::size_t s = 0; s < creased.size(); ++s)
    {
        const auto t = std::size_t(f.twin[s]);
        CHECK(creased[s] == creased[t]);
        CHECK(hidden[s] == hidden[t]);
        CHECK((creased[s] == 1 || creased[s] == 0.25 || creased[s] == 0.125));
        concave += creased[s] == 0.125;
        convex += creased[s] == 0.25;
        CHECK(hidden[s] <= 1);
        CHECK(hidden[s] >= 0.01);
        if (creased[s] == 0.125) CHECK(hidden[s] < 0.8);
    }
    CHECK(concave == 2 * 3);
    CHECK(convex > 10 * concave);
    const std::vector<double> weights(f.twin.size(), 7);
    for (const double x : impl::seam_factors(m, f, {.weights = weights}, {})) CHECK(x == 7);
}
