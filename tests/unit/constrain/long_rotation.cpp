// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/constraints.hpp>
#include <taut/impl/core/measure/rigid_motion.hpp>

using namespace taut;
using namespace taut::impl;

TEST_CASE("long rotation: parts are short, lead around as often as asked, and end at the targets")
{
    const std::vector<vec2> from{{1, 0}, {2, 0}, {2, 1}};
    const std::vector<idx> all{0, 1, 2};
    for (const double degrees : {200.0, -270.0, 720.0})
    {
        CAPTURE(degrees);
        const rigid_motion<2> motion{.to = {3, 0}, .angle = degrees * std::numbers::pi / 180};
        REQUIRE(long_rotation<2>::is_long(motion));
        const long_rotation<2> whole(all, from, motion);
        std::vector<vec2> to;
        for (const vec2& p : from) to.push_back(motion(p));
        to[1] += vec2(1e-3, 0); // as a file rounds it
        const int parts = whole.parts();
        CHECK(parts == static_cast<int>(std::ceil(std::abs(degrees) / 150)));
        double wound = 0;
        std::vector<vec2> last = from, x(3);
        for (int k = 1; k <= parts; ++k)
        {
            whole.place(double(k) / parts, from, to, x);
            const auto turn = fit_rigid_motion(std::span<const vec2>(last), std::span<const vec2>(x));
            wound += turn.angle * 180 / std::numbers::pi;
            last = x;
        }
        CHECK(wound == doctest::Approx(degrees).epsilon(1e-2));
        for (std::size_t v = 0; v < 3; ++v) CHECK(glm::distance(x[v], to[v]) < 1e-12);
    }
}

TEST_CASE("long rotation: what is done already is found in a map, also where ends look alike")
{
    const std::vector<vec3> from{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const rigid_motion<3> motion{.axis = glm::normalize(vec3(1, 2, 3)), .angle = 4 * std::numbers::pi};
    long_rotation<3> r(std::vector<idx>{0, 1, 2}, from, motion);
    CHECK(r.parts() == 5);
    r.find_done(from); // the end is here, too
    CHECK(r.parts() == 5);
    std::vector<vec3> x;
    for (const vec3& p : from) x.push_back(motion(p, 0.2));
    r.find_done(x);
    CHECK(r.parts() == 4);
    CHECK(r.turned() == doctest::Approx(0.2 * r.angle()));
    x.clear();
    for (const vec3& p : from) x.push_back(motion(p, 0.45)); // a quarter turn more than half of it, less 10 per cent
    r.find_done(x);
    CHECK(r.parts() == 3);
}

TEST_CASE("constraints: rotations are kept with the pins that they lead, and go with them")
{
    const auto m = test::grid(3, 3);
    const std::vector<idx> some{0, 1};
    const rigid_motion<2> far{.angle = 4};
    auto pins = constraints(m).move(some, far);
    REQUIRE(pins.rotations().size() == 1);
    CHECK(pins.rotations()[0].vertices() == some);
    CHECK(constraints(m).move(some, rigid_motion<2>{.angle = 1}).rotations().empty()); // places tell it
    pins.repin(0, vec2(0, 0));
    CHECK(pins.rotations()[0].vertices() == std::vector<idx>{1});
    pins.release(1);
    CHECK(pins.rotations().empty());
    pins.repin(some, std::vector<vec2>{{0, 0}, {1, 0}}, far);
    CHECK(pins.rotations().size() == 1);
    CHECK(pins.pins().at(1).value == far(vec2(1, 0)));
}
