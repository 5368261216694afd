// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/impl/core/mesh/incidence.hpp>

using namespace taut;
using namespace taut::impl;
using taut::idx;

TEST_CASE("generated meshes: planar ones are counter-clockwise")
{
    for (const auto& m : {test::grid(5, 3), test::flat_disk(9), test::fan(7), test::annulus(9), test::bumpy(9, 0.0)})
        for (taut::idx c = 0; c < m.cell_count(); ++c)
        {
            const auto x = m.rest(c);
            CHECK(triangle::determinant({vec2(x[0]), vec2(x[1]), vec2(x[2])}) > 0);
        }
}

TEST_CASE("generated meshes: closed and curved ones face outward")
{
    const auto outward = [](const mesh<triangle>& m, vec3 centre)
    {
        for (taut::idx c = 0; c < m.cell_count(); ++c)
        {
            const auto x = m.rest(c);
            CHECK(glm::dot(glm::cross(x[1] - x[0], x[2] - x[0]), x[0] - centre) > 0);
        }
    };
    outward(test::octahedron(), vec3(0.0));
    outward(test::cap(6), vec3(0.0));
    outward(test::tube(12, 2), vec3(0, 0, 1));
}

TEST_CASE("generated meshes: the bumpy disk is irregular, and the same every time")
{
    const auto m = test::bumpy(20);
    const auto around = vertex_neighbours(m);
    std::size_t low = 99, high = 0;
    for (taut::idx v = 0; v < m.vertex_count(); ++v)
    {
        low = std::min(low, around.row(v).size());
        high = std::max(high, around.row(v).size());
    }
    CHECK(low <= 3);
    CHECK(high >= 9);
    CHECK(m.points() == test::bumpy(20).points());
    CHECK(m.points() != test::bumpy(20, 0.15, 2).points());
}
