// SPDX-License-Identifier: MIT
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>
#include <support/winding.hpp>

#include <taut/energies.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>
#include <taut/parameterize.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

/// A wavy disk; no triangle has three vertices on its boundary.
mesh<triangle> hills()
{
    return test::rings(test::sized(16, 5),
                       [](double r, double angle)
                       {
                           const double x = r * std::cos(angle), y = r * std::sin(angle);
                           return vec3(x, y, 0.15 * std::sin(7 * x + 1) * std::cos(9 * y));
                       });
}

bool certified(const mesh<triangle>& m, const map_result& r)
{
    return r && certify<2>(m.cells(), std::span<const vec2>(r.uv)) && test::wound_vertices(m, r.uv).empty();
}

/// Bit for bit.
void check_pins(const constraints<triangle>& wanted, const map_result& r)
{
    for (const auto& [v, pin] : wanted.pins())
        for (int k = 0; k < 2; ++k)
            if ((pin.held >> k & 1u) != 0)
                CHECK(std::bit_cast<std::uint64_t>(r.uv[static_cast<std::size_t>(v)][k]) ==
                      std::bit_cast<std::uint64_t>(pin.value[k]));
}

vec2 swirled(const vec2& p, double angle)
{
    const double a = angle * std::exp(-glm::dot(p, p)), c = std::cos(a), s = std::sin(a);
    return {c * p.x - s * p.y, s * p.x + c * p.y};
}

TEST_CASE("pins: interior vertices that are moved stay bit for bit, the map is certified and converged")
{
    queue q(test::shared_context());
    const auto m = hills();
    const auto free = parameterize(q, m);
    REQUIRE(free);
    constraints<triangle> pins(m);
    const auto n = static_cast<taut::idx>(free.uv.size());
    for (taut::idx v = 3; v < n; v += n / 12)
        pins.pin(v, swirled(free.uv[static_cast<std::size_t>(v)], 0.5) + vec2(7.0, -3.0));
    const auto r = parameterize(q, m, {.constraints = pins});
    CAPTURE(r.reason());
    CHECK(r.report.pin_origins.size() == pins.pins().size());
    CHECK(certified(m, r));
    check_pins(pins, r);
    CHECK(r.report.solve.stop == solve::stop::gradient);
    CHECK(r.report.solve.value >= free.report.solve.value);
}

TEST_CASE("pins: none is met by the free map's turned, scaled or shifted image, and the result is that image")
{
    queue q(test::shared_context());
    const auto m = hills();
    const auto free = parameterize(q, m);
    constraints<triangle> pins(m);
    const auto turned = [](const vec2& p) { return vec2(-p.y, p.x) + vec2(20, 30); };
    const auto n = free.uv.size();
    for (const std::size_t v : {n / 5, n / 2}) pins.pin(static_cast<taut::idx>(v), turned(free.uv[v]));
    const auto r = parameterize(q, m, {.constraints = pins});
    CHECK(certified(m, r));
    check_pins(pins, r);
    CHECK(r.report.solve.value == doctest::Approx(free.report.solve.value).epsilon(1e-5));
    double worst = 0;
    for (std::size_t v = 0; v < n; ++v) worst = std::max(worst, glm::distance(r.uv[v], turned(free.uv[v])));
    CHECK(worst < 1e-2);
}

TEST_CASE("pins: a stop once there is a start leaves it, with its pins in place")
{
    queue q(test::shared_context());
    const auto m = hills();
    const auto free = parameterize(q, m);
    REQUIRE(free);
    auto pins = taut::constraints(m);
    for (const idx v : {0, 5, 11}) pins.pin(v, free.uv[static_cast<std::size_t>(v)] + vec2(40, 3)); // not at the origin
    for (const int questions : {0, 1, 2, 5, 20})
    {
        CAPTURE(questions);
        int usable = 0;
        const auto r = parameterize(q, m, {.constraints = pins},
                                    {.observer = [&](const auto& p) { return !p.usable || usable++ < questions; }});
        CHECK(usable == questions + 1);
        CHECK(r.report.solve.stop == solve::stop::user);
        CHECK(certified(m, r));
        if (r) check_pins(pins, r);
    }
}

TEST_CASE("pins: a boundary that is pinned to a polygon that is not convex, and a vertex inside")
{
    queue q(test::shared_context());
    const auto m = hills();
    constraints<triangle> pins(m);
    // A letter L.
    pins.pin_boundary(std::vector<vec2>{{0, 0}, {2, 0}, {2, 0.8}, {0.8, 0.8}, {0.8, 2}, {0, 2}});
    pins.pin(0, vec2(0.375, 0.5)); // the middle of the disk
    const auto r = parameterize(q, m, {.constraints = pins});
    CAPTURE(r.reason());
    CHECK(certified(m, r));
    check_pins(pins, r);
    CHECK(!r.report.untangling.empty());
}

TEST_CASE("pins: one coordinate of a vertex holds exactly while the other moves")
{
    queue q(test::shared_context());
    const auto m = hills();
    const auto free = parameterize(q, m);
    constraints<triangle> pins(m);
    const auto loop = boundary_loops(m)[0];
    for (std::size_t k = 0; k < loop.size() / 3; ++k) pins.pin_v(loop[k], 0.125);
    const auto r = parameterize(q, m, {.constraints = pins});
    CAPTURE(r.reason());
    CHECK(certified(m, r));
    check_pins(pins, r);
    CHECK(r.report.solve.stop == solve::stop::gradient);
    CHECK(r.report.solve.value > free.report.solve.value);
}

TEST_CASE("springs: the stiffer, the nearer; together with a pin, too")
{
    queue q(test::shared_context());
    const auto m = hills();
    const auto free = parameterize(q, m);
    const std::size_t n = free.uv.size(), v = n / 2;
    const vec2 target = free.uv[v] + vec2(0.1, 0.05);
    double last = std::numeric_limits<double>::infinity();
    for (const double weight : {0.1, 10.0, 1000.0})
    {
        constraints<triangle> wanted(m);
        wanted.pin(0, free.uv[0]).pin(static_cast<taut::idx>(n - 1), free.uv[n - 1]);
        wanted.spring(static_cast<taut::idx>(v), target, weight);
        const auto r = parameterize(q, m, {.constraints = wanted});
        CHECK(certified(m, r));
        check_pins(wanted, r);
        CHECK(r.report.solve.stop == solve::stop::gradient);
        const double gap = glm::distance(r.uv[v], target);
        CHECK(gap < last);
        last = gap;
    }
    CHECK(last < 0.01);
}

TEST_CASE("springs: alone they place the map")
{
    queue q(test::shared_context());
    const auto m = hills();
    const auto free = parameterize(q, m);
    constraints<triangle> wanted(m);
    wanted.spring(1, free.uv[1] + vec2(100, 50), 1.0).spring(9, free.uv[9] + vec2(100, 50), 1.0);
    const auto r = parameterize(q, m, {.constraints = wanted});
    CHECK(certified(m, r));
    CHECK(glm::distance(r.uv[1], free.uv[1] + vec2(100, 50)) < 1e-3);
    CHECK(r.report.solve.value == doctest::Approx(free.report.solve.value).epsilon(1e-4));
}

TEST_CASE("pins: a triangle that is pinned upside down is infeasible, and named")
{
    queue q(test::shared_context());
    const auto m = hills();
    constraints<triangle> pins(m);
    const auto& t = m.cells()[17];
    pins.pin(t[0], vec2(0, 0)).pin(t[1], vec2(0, 1)).pin(t[2], vec2(1, 0));
    const auto r = parameterize(q, m, {.constraints = pins});
    CHECK(!r);
    CHECK(r.report.outcome == outcome::infeasible);
    CHECK(std::find(r.report.ids.begin(), r.report.ids.end(), 17) != r.report.ids.end());
    CHECK(r.reason().find("17") != std::string::npos);
}

TEST_CASE("pins: with a fixed boundary and a start of one's own they hold, too")
{
    queue q(test::shared_context());
    const auto m = hills();
    const auto start = barycentric_map(m, facets(m), {}).uv;
    constraints<triangle> pins(m);
    const std::size_t v = start.size() / 2;
    pins.pin(static_cast<taut::idx>(v), start[v] + vec2(0.02, 0.03));
    parameterize_params p{.boundary = boundary_mode::fixed, .constraints = pins, .initial = start};
    const auto r = parameterize(q, m, p);
    CAPTURE(r.reason());
    CHECK(certified(m, r));
    check_pins(pins, r);
    const auto loop = boundary_loops(m)[0];
    for (const taut::idx b : loop) CHECK(r.uv[static_cast<std::size_t>(b)] == start[static_cast<std::size_t>(b)]);
}

TEST_CASE("start: flipped, collapsed and scrambled triangles are untangled, mirrored ones turned over")
{
    queue q(test::shared_context());
    const auto m = hills();
    const auto good = parameterize(q, m);
    REQUIRE(good);
    for (const std::string kind : {"flipped", "collapsed", "scrambled", "mirrored"})
    {
        CAPTURE(kind);
        auto start = good.uv;
        std::mt19937 random(5);
        std::uniform_real_distribution<double> any(-0.5, 0.5);
        const std::size_t n = start.size();
        if (kind == "flipped") std::swap(start[n / 2], start[n / 2 + 1]);
        if (kind == "collapsed")
            for (std::size_t v = n / 4; v < n / 2; ++v) start[v] = start[n / 4];
        if (kind == "scrambled")
            for (vec2& p : start) p = {any(random), any(random)};
        if (kind == "mirrored")
            for (vec2& p : start) p.y = -p.y;
        const auto r = parameterize(q, m, {.initial = start});
        CAPTURE(r.reason());
        CHECK(certified(m, r));
        CHECK(r.report.solve.value == doctest::Approx(good.report.solve.value).epsilon(1e-3));
    }
}

TEST_CASE("pins: an energy that does not see scale keeps the scale that the pins give")
{
    queue q(test::shared_context());
    const auto m = hills();
    constraints<triangle> pins(m);
    pins.pin(0, vec2(0, 0)).pin(static_cast<taut::idx>(m.vertex_count() - 1), vec2(50, 0));
    const auto r = parameterize(q, m, {.energy = energy::shape{}, .constraints = pins});
    CAPTURE(r.reason());
    CHECK(certified(m, r));
    check_pins(pins, r);
}

TEST_CASE("pins: numbers at the ends of the range come out bit for bit")
{
    queue q(test::shared_context());
    auto points = hills().points();
    for (vec3& p : points) p *= 1e6;
    const mesh<triangle> m(std::move(points), hills().cells());
    for (const vec2 place : {vec2(1e-310, 5e-324), vec2(-0.0, 1e-300), vec2(-5e-324, 3e6)})
    {
        constraints<triangle> pins(m);
        pins.pin(20, place);
        const auto r = parameterize(q, m, {.constraints = pins});
        CAPTURE(r.reason());
        CHECK(certified(m, r));
        check_pins(pins, r);
    }
}

TEST_CASE("pins: a few that are moved far, with a free boundary, leave no vertex that the map winds around twice")
{
    queue q(test::shared_context());
    const auto m = test::bumpy(test::sized(24, 8), 0.4, 11);
    const auto free = parameterize(q, m);
    REQUIRE(free);
    std::mt19937 random(1);
    const auto uniform = [&](double from, double to)
    { return from + (to - from) * (static_cast<double>(random()) / random.max()); };
    for (int k = 0; k < test::sized(8, 2); ++k)
    {
        CAPTURE(k);
        constraints<triangle> pins(m);
        while (pins.pins().size() < 5)
        {
            const std::size_t v = random() % free.uv.size();
            if (!pins.pins().contains(static_cast<taut::idx>(v)))
                pins.pin(static_cast<taut::idx>(v), free.uv[v] + vec2(uniform(-0.3, 0.3), uniform(-0.3, 0.3)));
        }
        const auto r = parameterize(q, m, {.constraints = pins});
        CAPTURE(r.reason());
        CHECK(certified(m, r));
        check_pins(pins, r);
    }
}

TEST_CASE("pins: those of another mesh are refused with the vertex")
{
    queue q(test::shared_context());
    const auto m = hills(), large = test::bumpy(40, 0.2, 2);
    constraints<triangle> pins(large);
    pins.pin(large.vertex_count() - 1, vec2(0.0));
    CHECK_THROWS_WITH_AS(parameterize(q, m, {.constraints = pins}),
                         doctest::Contains(std::to_string(large.vertex_count() - 1).c_str()), parameter_error);
}

} // namespace
