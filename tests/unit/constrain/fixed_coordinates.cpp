// SPDX-License-Identifier: MIT
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/impl/core/constrain/fixed_coordinates.hpp>

using namespace taut;
using namespace taut::impl;

TEST_CASE("fixed coordinates: pins, vertices that keep their positions, and slides, relative to the first map")
{
    const auto m = test::grid(4, 3);
    std::vector<vec2> start;
    for (const vec3& p : m.points()) start.emplace_back(p);
    fixed_coordinates<triangle> fixed(start, {0, 1}, {slide<2>::along(5, {1, 0})});
    constraints<triangle> pins(m);
    pins.pin(1, {9, 8}).pin_u(7, 4);
    CHECK(fixed.take(pins));
    CHECK(!fixed.take(pins)); // the same coordinates again
    CHECK(fixed.marks().all(0));
    CHECK(fixed.marks()[7] == 1);
    CHECK(fixed.targets()[0] == start[0]);
    CHECK(fixed.targets()[1] == vec2(9, 8));

    std::vector<vec2> x(start.size(), vec2(0.25));
    CHECK(fixed.gap(x).vertex == 1);
    CHECK(fixed.gap(x, [&](std::size_t v) { return x[v]; }).vertex == -1);
    fixed.impose(x);
    CHECK(fixed.gap(x).vertex == -1);
    CHECK(x[7] == vec2(4, 0.25));
    CHECK(x[5] == vec2(0.25, start[5].y));
    CHECK(x[6] == vec2(0.25));

    CHECK(fixed.take(constraints<triangle>(m))); // released: vertex 1 goes back, vertex 7 is free
    CHECK(fixed.targets()[1] == start[1]);
    CHECK(!fixed.marks().any(7));
}

TEST_CASE("fixed coordinates: those that a device has rounded are set to the last bit, others stay")
{
    const auto m = test::grid(2, 2);
    fixed_coordinates<triangle> fixed(std::vector<vec2>(9, vec2(0)), {});
    constraints<triangle> pins(m);
    pins.pin(0, {0.1, 0.2}).pin(3, {0.3, 0.4});
    fixed.take(pins);
    const auto rounded = [&](std::size_t v) { return vec2(float(fixed.targets()[v].x), float(fixed.targets()[v].y)); };
    std::vector<vec2> x(9, vec2(0.7));
    x[0] = rounded(0);
    fixed.impose(x, rounded);
    CHECK(x[0] == vec2(0.1, 0.2));
    CHECK(x[3] == vec2(0.7));
}

TEST_CASE("fixed coordinates: those of a map in other lengths are set alone, pins exactly")
{
    const auto m = test::grid(2, 2);
    fixed_coordinates<triangle> fixed(std::vector<vec2>(9, vec2(0)), {});
    constraints<triangle> pins(m);
    pins.pin(0, {0.1, 0.2}).pin_u(3, -0.3);
    fixed.take(pins);
    std::vector<vec2> x(9, vec2(0.7));
    fixed.impose_scaled(x, 4);
    CHECK(x[0] == vec2(4 * 0.1, 4 * 0.2));
    CHECK(x[3] == vec2(4 * -0.3, 0.7));
    CHECK(x[4] == vec2(0.7));
}
