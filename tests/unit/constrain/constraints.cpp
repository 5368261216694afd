// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/impl/files/surface/pins.hpp>
#include <taut/volume_file.hpp>

using namespace taut;

namespace
{

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

template <class Call>
void check_refused(const Call& call, constraint_error::fault_type fault, const std::vector<taut::idx>& ids)
{
    try
    {
        call();
        FAIL("accepted");
    }
    catch (const constraint_error& e)
    {
        CHECK(e.fault() == fault);
        CHECK(e.ids() == ids);
        const std::string text = e.what();
        CHECK(text.find(';') != text.npos); // a remedy
        if (!ids.empty()) CHECK(text.find(std::to_string(ids[0])) != text.npos);
    }
}

} // namespace

TEST_CASE("constraints: pins, single coordinates and springs are kept by vertex")
{
    const auto m = test::grid(4, 4);
    const auto c = taut::constraints(m).pin(12, {0.0, 1.0}).pin_u(5, 0.3).pin_v(6, -2).spring(4, {0.5, 0.5}, 10.0);
    CHECK(c.held(12) == 3);
    CHECK(c.held(5) == 1);
    CHECK(c.held(6) == 2);
    CHECK(c.held(4) == 0);
    CHECK(c.pins().at(12).value == vec2(0, 1));
    CHECK(c.pins().at(5).value.x == 0.3);
    CHECK(c.pins().at(6).value.y == -2);
    REQUIRE(c.springs().size() == 1);
    CHECK(c.springs()[0].vertex == 4);
    CHECK(c.springs()[0].target == vec2(0.5));
    CHECK(c.springs()[0].weight == 10);
    CHECK(!c.empty());
    CHECK(taut::constraints(m).empty());
    CHECK(constraints<triangle>().empty());

    // u and v of one vertex, one after the other.
    CHECK(taut::constraints(m).pin_u(5, 1).pin(5, 1, 2).held(5) == 3);
}

TEST_CASE("constraints: what cannot hold is refused with the vertices it concerns")
{
    const auto m = test::grid(4, 4); // 25 vertices
    auto c = taut::constraints(m).pin(3, {1, 1}).pin_u(5, 0.5).spring(7, {0, 0}, 1);
    using f = constraint_error::fault_type;
    check_refused([&] { c.pin(25, {0, 0}); }, f::out_of_range, {25});
    check_refused([&] { c.pin(-1, {0, 0}); }, f::out_of_range, {-1});
    check_refused([&] { c.spring(99, {0, 0}, 1); }, f::out_of_range, {99});
    check_refused([&] { c.pin(4, {not_a_number, 0}); }, f::not_finite, {4});
    check_refused([&] { c.pin_v(4, infinite); }, f::not_finite, {4});
    check_refused([&] { c.spring(4, {0, -infinite}, 1); }, f::not_finite, {4});
    check_refused([&] { c.pin(4, {1e308, 0}); }, f::not_finite, {4}); // two of these may be infinitely far apart
    check_refused([&] { c.spring(4, {0, -1e308}, 1); }, f::not_finite, {4});
    check_refused([&] { c.pin(3, {1, 2}); }, f::contradictory, {3});
    check_refused([&] { c.pin_u(5, 0.75); }, f::contradictory, {5});
    check_refused([&] { c.pin(3, {1, 1}); }, f::duplicate, {3});
    check_refused([&] { c.pin(5, {0.5, 0}); }, f::duplicate, {5});
    check_refused([&] { c.spring(7, {1, 1}, 2); }, f::duplicate, {7});
    check_refused([&] { c.spring(4, {1, 1}, -1); }, f::bad_weight, {4});
    check_refused([&] { c.spring(4, {1, 1}, infinite); }, f::bad_weight, {4});
    check_refused([&] { c.spring(4, {1, 1}, not_a_number); }, f::bad_weight, {4});
    check_refused([&] { c.spring(3, {1, 1}, 1); }, f::idle_spring, {3});
    check_refused([&] { c.pin(7, {1, 1}); }, f::idle_spring, {7});
    check_refused([&] { c.pin(4, 2, 1.0); }, f::no_coordinate, {4});
    CHECK_THROWS_WITH_AS(c.pin(4, 2, 1.0), doctest::Contains("coordinate 2; they count from 0 to 1"), constraint_error);
    check_refused([] { constraints<triangle>().pin(0, {0, 0}); }, f::out_of_range, {0});

    // Sets: every vertex at fault is named, and nothing of the call is kept.
    const std::vector<taut::idx> ids{1, 3, 5, 8};
    std::vector<vec2> x(25, vec2(9));
    check_refused([&] { c.fix(ids, x); }, f::contradictory, {3, 5});
    const std::vector<taut::idx> twice{1, 8, 1};
    check_refused([&] { c.fix(twice, x); }, f::duplicate, {1});
    const std::vector<taut::idx> far{1, 30, 31};
    check_refused([&] { c.fix(far, x); }, f::out_of_range, {30, 31});
    check_refused([&] { c.fix(ids, std::vector<vec2>(24)); }, f::wrong_count, {});
    CHECK(c.pins().size() == 2);
    CHECK(c.springs().size() == 1);
    // A coordinate alone leaves a spring its other one.
    CHECK_NOTHROW(c.pin_u(7, 0));
}

TEST_CASE("constraints: pins and springs are moved and taken back")
{
    const auto m = test::grid(2, 2);
    constraints<triangle> c(m);
    c.pin(0, {1, 2}).pin_u(1, 3).spring(5, {1, 1}, 2);
    c.repin(0, {4, 5}).repin(1, 1, 6).repin(2, {7, 8}).respring(5, {2, 2}, 3).respring(6, {0, 0}, 1);
    CHECK(c.pins().at(0).value == vec2(4, 5));
    CHECK(c.held(1) == 3);
    CHECK(c.pins().at(1).value == vec2(3, 6));
    CHECK(c.held(2) == 3);
    REQUIRE(c.springs().size() == 2);
    CHECK(c.springs()[0].target == vec2(2, 2));
    CHECK(c.springs()[0].weight == 3);
    c.repin(std::vector<taut::idx>{0, 3}, std::vector<vec2>{{0, 0}, {1, 0}});
    CHECK(c.pins().at(0).value == vec2(0, 0));
    c.release(0).release(5).release(8); // the last one is not held
    CHECK(c.held(0) == 0);
    CHECK(c.springs().size() == 1);
}

TEST_CASE("constraints: moving pins keeps what cannot hold out, and leaves what was there")
{
    const auto m = test::grid(2, 2);
    constraints<triangle> c(m);
    c.pin(0, {1, 2}).spring(5, {1, 1}, 2);
    check_refused([&] { c.repin(9, {0, 0}); }, constraint_error::out_of_range, {9});
    check_refused([&] { c.repin(0, {0, not_a_number}); }, constraint_error::not_finite, {0});
    check_refused([&] { c.repin(0, 2, 0.0); }, constraint_error::no_coordinate, {0});
    check_refused([&] { c.repin(5, {0, 0}); }, constraint_error::idle_spring, {5});
    check_refused(
        [&] {
            c.repin(std::vector<taut::idx>{1, 1}, std::vector<vec2>{{0, 0}, {1, 0}});
        },
        constraint_error::contradictory, {1});
    check_refused(
        [&] {
            c.repin(std::vector<taut::idx>{1, 2}, std::vector<vec2>{{0, 0}});
        },
        constraint_error::wrong_count, {});
    check_refused([&] { c.respring(5, {0, 0}, -1); }, constraint_error::bad_weight, {5});
    check_refused([&] { c.release(-1); }, constraint_error::out_of_range, {-1});
    CHECK(c.pins().size() == 1);
    CHECK(c.pins().at(0).value == vec2(1, 2));
    REQUIRE(c.springs().size() == 1);
    CHECK(c.springs()[0].weight == 2);
}

TEST_CASE("constraints: sets are fixed where they are and moved by a transform")
{
    const auto flat = test::grid(3, 3);
    const std::vector<taut::idx> ids{0, 5, 15};
    const auto right = [](const vec2& p) { return p + vec2(1, 0); };
    const auto c = taut::constraints(flat).move(ids, right);
    CHECK(c.pins().at(15).value == vec2(2, 1));
    CHECK(c.pins().size() == 3);
    std::vector<vec2> x(16, vec2(4, 5));
    CHECK(taut::constraints(flat).fix(ids, x).pins().at(5).value == vec2(4, 5));
    CHECK(taut::constraints(flat).move(ids, x, right).pins().at(5).value == vec2(5, 5));
    CHECK(taut::constraints(flat).fix(ids).pins().at(15).value == vec2(1, 1));

    const auto wavy = test::bumpy(3);
    check_refused([&] { taut::constraints(wavy).fix(ids); }, constraint_error::no_position, {});

    const auto volume = test::cube(2);
    const auto lifted = taut::constraints(volume).fix({0}).move(std::vector<taut::idx>{26},
                                                                [](const vec3& p) { return p + vec3(0, 0, 0.2); });
    CHECK(lifted.pins().at(26).value == vec3(1, 1, 1.2));
    CHECK(lifted.held(0) == 7);
    CHECK(taut::constraints(volume).pin(3, 2, 0.5).held(3) == 4);
    CHECK_THROWS_WITH_AS(taut::constraints(volume).move(ids, taut::rigid_motion<3>{.axis = {0, 0, 2}}),
                         doctest::Contains("length 1"), taut::parameter_error);
}

TEST_CASE("constraints: the boundary goes around a polygon by arc length")
{
    const auto m = test::grid(4, 4);
    const std::vector<vec2> square{{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    const auto c = taut::constraints(m).pin_boundary(square);
    CHECK(c.pins().size() == 16);
    for (const auto& [v, p] : c.pins()) // the grid's own outline, twice as large
        CHECK(glm::distance(p.value, 2.0 * vec2(m.points()[std::size_t(v)])) < 1e-15);
    const auto turned = taut::constraints(m).pin_boundary(square, 4);
    CHECK(turned.pins().at(4).value == vec2(0, 0));
    CHECK(turned.pins().at(24).value == vec2(2, 0));
    check_refused([&] { taut::constraints(m).pin_boundary(square, 12); }, constraint_error::out_of_range, {12});

    using f = constraint_error::fault_type;
    const auto pin_to = [&](std::vector<vec2> polygon)
    { return [&m, polygon = std::move(polygon)] { taut::constraints(m).pin_boundary(polygon); }; };
    check_refused(pin_to({{0, 0}, {1, 0}}), f::bad_polygon, {});
    check_refused(pin_to({{1, 1}, {1, 1}, {1, 1}}), f::bad_polygon, {});
    check_refused(pin_to({{0, 0}, {not_a_number, 1}, {1, 1}}), f::bad_polygon, {});
    // Corners may coincide.
    CHECK_NOTHROW(pin_to({{0, 0}, {0, 0}, {1, 0}, {1, 1}, {1, 1}})());

    std::vector<vec2> positions(16, vec2(3));
    CHECK(taut::constraints(m).pin_boundary_at(positions).pins().at(0).value == vec2(3));
    positions.pop_back();
    check_refused([&] { taut::constraints(m).pin_boundary_at(positions); }, f::wrong_count, {});
    const auto disk = test::flat_disk(2); // its vertex 0 is inside
    check_refused([&] { taut::constraints(disk).pin_boundary(square, 0); }, f::out_of_range, {0});
    const auto closed = test::octahedron();
    CHECK_THROWS_AS(taut::constraints(closed).pin_boundary(square), mesh_error);
    const auto ring = test::annulus(5);
    CHECK_THROWS_AS(taut::constraints(ring).pin_boundary(square), mesh_error);
}

TEST_CASE("constraints: a problem holds the pins bit for bit, whatever the map has there")
{
    const auto m = test::grid(2, 2);
    const auto c = taut::constraints(m).pin(0, {0.1, 0.2}).pin_v(8, 1.0 / 3).spring(4, {0, 0}, 1);
    const auto p = make_untangle_problem(m, std::vector<vec2>(9, vec2(7)), c);
    CHECK_NOTHROW(p.validate());
    CHECK(p.initial[0] == vec2(0.1, 0.2));
    CHECK(p.initial[8] == vec2(7, 1.0 / 3));
    CHECK(p.held.bits() == std::vector<std::uint8_t>{3, 0, 0, 0, 0, 0, 0, 0, 2});
    check_refused([&] { make_untangle_problem(m, std::vector<vec2>(8), c); }, constraint_error::wrong_count, {});
}

TEST_CASE("constraints: a file of pins becomes pins and springs")
{
    const auto m = test::grid(2, 2);
    auto c = taut::constraints(m);
    c.add(io::impl::parse_pins<2>("0,1,2\n3,,4\n5,0.5,0.5,2\n"));
    CHECK(c.held(0) == 3);
    CHECK(c.held(3) == 2);
    CHECK(c.springs().at(0).vertex == 5);
    check_refused([&] { c.add(io::impl::parse_pins<2>("0,1,3\n")); }, constraint_error::contradictory, {0});
}

TEST_CASE("constraints: targets that another unit brings out of range are named")
{
    const auto m = test::grid(2, 2);
    auto c = taut::constraints(m).pin(1, {8e307, -8e307}).pin_u(2, -1e200).spring(3, {0, 1e300}, 1);
    c.require_near(1);
    c.require_near(1e-300);
    try
    {
        c.require_near(0x1p40);
        FAIL("no error");
    }
    catch (const constraint_error& e)
    {
        CHECK(e.fault() == constraint_error::not_finite);
        CHECK(e.ids() == std::vector<idx>{1, 3});
    }
}
