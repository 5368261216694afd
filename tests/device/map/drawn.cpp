// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <support/chart_checks.hpp>
#include <support/extreme_meshes.hpp>
#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>
#include <support/winding.hpp>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/charts/atlas/cut_to_disk.hpp>
#include <taut/parameterize.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

/// A wavy disk that has coarser levels.
mesh<triangle> waves()
{
    return test::rings(test::sized(40, 24),
                       [](double r, double angle)
                       {
                           const double x = r * std::cos(angle), y = r * std::sin(angle);
                           return vec3(x, y, 0.1 * std::sin(8 * x + 1) * std::cos(9 * y));
                       });
}

/// Its free map with the boundary pinned.
struct bound_map
{
    queue q{test::shared_context()};
    mesh<triangle> m;
    std::vector<vec2> free = parameterize(q, m).uv;
    vec2 centre{0};
    double radius = INFINITY;
    constraints<triangle> pins{m};

    explicit bound_map(mesh<triangle> surface = waves()) : m(std::move(surface))
    {
        const auto boundary = boundary_loops(m).front();
        for (const idx v : boundary) centre += free[static_cast<std::size_t>(v)] / double(boundary.size());
        for (const idx v : boundary)
            radius = std::min(radius, glm::distance(centre, free[static_cast<std::size_t>(v)]));
        pins.fix(boundary, free);
    }

    /// Turned by an angle at the centre, and not at all beyond the radius.
    vec2 swirled(const vec2& p, double angle) const
    {
        const double a = angle * std::max(0.0, 1 - glm::distance(p, centre) / radius), c = std::cos(a), s = std::sin(a);
        return centre + mat2(c, s, -s, c) * (p - centre);
    }

    /// Each of `count` vertices spread over the inside.
    template <class Body>
    void inside(int count, const Body& body) const
    {
        const int n = static_cast<int>(free.size());
        for (int k = 0; k < count; ++k)
        {
            const idx v = static_cast<idx>((n - 1) * (2 * k + 1) / (2 * count));
            if (glm::distance(free[static_cast<std::size_t>(v)], centre) < 0.8 * radius)
                body(v, free[static_cast<std::size_t>(v)]);
        }
    }

    /// Vertices at random turn about the middle, every other one against the others if wanted, by less where the
    /// boundary is near.
    void turn(int count, double angle, bool both_ways, unsigned seed)
    {
        const auto boundary = boundary_loops(m).front();
        std::vector<bool> taken(free.size());
        for (const idx v : boundary) taken[static_cast<std::size_t>(v)] = true;
        vec2 middle(0);
        for (const vec2& p : free) middle += p / double(free.size());
        const double size = glm::distance(free[static_cast<std::size_t>(boundary[0])], middle);
        std::mt19937 rng(seed);
        for (int done = 0; done < count;)
        {
            const std::size_t v = rng() % free.size();
            double room = INFINITY;
            for (const idx w : boundary)
                room = std::min(room, glm::distance(free[v], free[static_cast<std::size_t>(w)]));
            if (taken[v] || room < 0.02 * size) continue;
            taken[v] = true;
            const vec2 arm = free[v] - middle;
            double a = std::min(angle, 0.7 * room / std::max(1e-9, glm::length(arm)));
            if (both_ways && done % 2 != 0) a = -a;
            const double c = std::cos(a), s = std::sin(a);
            pins.pin(static_cast<idx>(v), middle + mat2(c, s, -s, c) * arm);
            ++done;
        }
    }

    void check(const map_result& r) const
    {
        CAPTURE(r.reason());
        REQUIRE(r);
        CHECK(certify<2>(m.cells(), std::span<const vec2>(r.uv)));
        CHECK(test::wound_vertices(m, r.uv).empty());
        for (const auto& [v, pin] : pins.pins())
            for (int k = 0; k < 2; ++k)
                if ((pin.held >> k & 1u) != 0)
                    CHECK(std::bit_cast<std::uint64_t>(r.uv[static_cast<std::size_t>(v)][k]) ==
                          std::bit_cast<std::uint64_t>(pin.value[k]));
    }
};

std::string stage(const map_result& r)
{
    return r.report.untangling.empty() ? "" : r.report.untangling.back().stage;
}

TEST_CASE("drawn start: pins inside a pinned boundary swirl, hold bit for bit, and cost no more than untangled ones")
{
    bound_map b;
    b.inside(12, [&](idx v, const vec2& p) { b.pins.pin(v, b.swirled(p, 1.2)); });
    const auto drawn = parameterize(b.q, b.m, {.constraints = b.pins});
    b.check(drawn);
    CHECK(stage(drawn) == "draw");
    CHECK(!drawn.report.levels.empty());
    CHECK(drawn.report.pin_origins.size() == b.pins.pins().size());
    CHECK(drawn.report.solve.stop == solve::stop::gradient);
    const auto untangled = parameterize(b.q, b.m, {.constraints = b.pins, .start = start_method::barycentric});
    b.check(untangled);
    CHECK(stage(untangled) != "draw");
    CHECK(drawn.report.solve.value <= 1.001 * untangled.report.solve.value);
}

TEST_CASE("drawn start: pins that are where the map is anyway change nothing")
{
    bound_map b;
    b.inside(8, [&](idx v, const vec2& p) { b.pins.pin(v, p); });
    const auto r = parameterize(b.q, b.m, {.constraints = b.pins});
    b.check(r);
    CHECK(stage(r) == "draw");
    double worst = 0;
    for (std::size_t v = 0; v < b.free.size(); ++v) worst = std::max(worst, glm::distance(r.uv[v], b.free[v]));
    CHECK(worst < 1e-3 * b.radius);
}

TEST_CASE("drawn start: a map that has settled is within a thousandth of where stopping parameters of one's own lead")
{
    bound_map b;
    b.turn(test::sized(60, 10), 0.5, true, 3);
    const auto settled = parameterize(b.q, b.m, {.constraints = b.pins});
    b.check(settled);
    const auto strict = parameterize(b.q, b.m, {.constraints = b.pins, .solve = {.max_iterations = 1000}});
    b.check(strict);
    const auto &s = settled.report.solve, &t = strict.report.solve;
    CHECK(parameterize_params{}.solve.tuning.stopping.settled_tolerance > 0);
    CHECK((s.stop == solve::stop::settled || s.iterations == t.iterations));
    CHECK((t.stop == solve::stop::gradient || t.stop == solve::stop::decrement));
    CHECK(s.iterations <= t.iterations);
    CHECK(s.value >= t.value);
    CHECK(s.value - t.value <= 1e-3 * (t.value - energy::rest_value<2>(default_energy())));
}

TEST_CASE("drawn start: where nothing fits in the outline of a map with limbs, untangling finds the map")
{
    const auto body = test::animal(24);
    const auto sides = facets(body);
    const auto cut = test::chart(cut_charts(body, sides, cut_to_disk(body, sides)), 0);
    for (const unsigned seed : {2U, 3U, 4U})
    {
        CAPTURE(seed);
        bound_map b(cut);
        b.turn(6, 1, false, seed);
        const auto r = parameterize(b.q, b.m, {.constraints = b.pins});
        b.check(r);
    }
}

TEST_CASE("drawn start: springs wait for what cannot follow yet")
{
    for (const int count : {20, 30})
    {
        CAPTURE(count);
        bound_map b;
        b.turn(count, 1, true, 5);
        const auto r = parameterize(b.q, b.m, {.constraints = b.pins});
        b.check(r);
        CHECK(stage(r) == "draw");
    }
}

TEST_CASE("drawn start: single coordinates, springs and a boundary that is not convex")
{
    bound_map b;
    b.pins = constraints<triangle>(b.m);
    b.pins.pin_boundary(std::vector<vec2>{{0, 0}, {2, 0}, {2, 0.8}, {0.8, 0.8}, {0.8, 2}, {0, 2}});
    b.pins.pin(0, {0.45, 0.4}).pin_u(30, 0.3).pin_v(60, 0.6).spring(90, {0.6, 0.3}, 10.0);
    const auto r = parameterize(b.q, b.m, {.constraints = b.pins});
    b.check(r);
    CHECK(stage(r) == "draw");
}

TEST_CASE("drawn start: where nothing can be drawn to its place, it is the untangling that answers")
{
    SUBCASE("with a proof")
    {
        bound_map b;
        b.pins.pin(0, b.centre + vec2(3 * b.radius, 0));
        const auto r = parameterize(b.q, b.m, {.constraints = b.pins});
        CHECK(r.report.outcome == outcome::infeasible);
        CHECK(!r.report.ids.empty());
    }
    SUBCASE("with a method that has no levels")
    {
        bound_map b;
        b.inside(4, [&](idx v, const vec2& p) { b.pins.pin(v, b.swirled(p, 0.5)); });
        const auto r = parameterize(b.q, b.m, {.constraints = b.pins, .solve = {.method = solve::method::lbfgs}});
        b.check(r);
        CHECK(stage(r) != "draw");
    }
}

TEST_CASE("drawn start: a stop on the way leaves no map, and one after it the map that it has")
{
    bound_map b;
    b.inside(12, [&](idx v, const vec2& p) { b.pins.pin(v, b.swirled(p, 1.2)); });
    int asked = 0;
    const auto early =
        parameterize(b.q, b.m, {.constraints = b.pins}, {.observer = [&](const auto&) { return ++asked < 10; }});
    CHECK(early.report.outcome == outcome::stopped);
    CHECK(early.uv.empty());
    const auto late =
        parameterize(b.q, b.m, {.constraints = b.pins}, {.observer = [](const auto& p) { return !p.usable; }});
    b.check(late);
    CHECK(late.report.solve.stop == solve::stop::user);
}

} // namespace
