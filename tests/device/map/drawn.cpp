// SPDX-License-Identifier: MIT
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/size.hpp>
#include <support/winding.hpp>

#include <taut/map/parameterize.hpp>

namespace
{

using namespace taut;

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
    queue q;
    mesh<triangle> m = waves();
    std::vector<vec2> free = parameterize(q, m).uv;
    vec2 centre{0};
    double radius = INFINITY;
    constraints<triangle> pins{m};

    bound_map()
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
        parameterize(b.q, b.m, {.constraints = b.pins, .observer = [&](const auto&) { return ++asked < 10; }});
    CHECK(early.report.outcome == outcome::stopped);
    CHECK(early.uv.empty());
    const auto late =
        parameterize(b.q, b.m, {.constraints = b.pins, .observer = [](const auto& p) { return !p.usable; }});
    b.check(late);
    CHECK(late.report.solve.stop == solve::stop::user);
}

} // namespace
