// SPDX-License-Identifier: MIT
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/impl/constrain/surface_constraints.hpp>

using namespace taut;
using namespace taut::impl;

TEST_CASE("held coordinates: how far pins are from their places, as a part of the size of those, in any unit")
{
    const auto m = test::grid(4, 3);
    constraints<triangle> pins(m);
    pins.pin(0, {1, 1}).pin(3, {3, 1}).pin(7, {3, 2}).pin(12, {1, 2}).pin_u(9, 40);
    for (const double unit : {1.0, 250.0})
    {
        const surface_constraints held(pins, m.points().size(), {}, unit);
        std::vector<vec2> uv(m.points().size(), vec2(0.3));
        held.impose(uv, unit);
        CHECK(held.misfit(uv) == 0);
        // A tenth larger about their centre.
        for (vec2& p : uv) p = held.centre() + 1.1 * (p - held.centre());
        CHECK(held.misfit(uv) == doctest::Approx(0.1));
        for (vec2& p : uv) p += vec2(0, 100 * unit);
        CHECK(held.misfit(uv) > 50);
    }
}

TEST_CASE("held coordinates: a single pin has no size to be far from")
{
    const auto m = test::grid(2, 2);
    constraints<triangle> pins(m);
    pins.pin(0, {1, 1});
    CHECK(surface_constraints(pins, m.points().size(), {}, 1).misfit(std::vector<vec2>(9, vec2(0))) == 0);
}
