// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>
#include <support/winding.hpp>

#include <taut/energies.hpp>
#include <taut/impl/core/energy/algebra.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/mesh.hpp>
#include <taut/parameterize.hpp>
#include <taut/session.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

mesh<triangle> bump()
{
    return test::rings(test::sized(14, 5), [](double r, double a)
                       { return vec3(r * std::cos(a), r * std::sin(a), 0.8 * std::exp(-4 * r * r)); });
}

/// A strip along two turns of a helix around a cone.
mesh<triangle> spiral()
{
    auto flat = test::grid(test::sized(60, 20), 4);
    auto points = flat.points();
    for (vec3& p : points)
    {
        const double a = 4 * 3.14159265358979 * p.x, r = 1 + 0.5 * p.x + 0.2 * p.y;
        p = vec3(r * std::cos(a), r * std::sin(a), 0.3 * a + 0.1 * p.y);
    }
    return {points, flat.cells()};
}

/// Twelve triangles around two vertices inside.
mesh<triangle> coarse()
{
    return test::rings(2, [](double r, double a) { return vec3(r * std::cos(a), r * std::sin(a), 0.3 * r * (1 - r)); });
}

double extent(const std::vector<vec2>& uv)
{
    vec2 low = uv.front(), high = low;
    for (const vec2& p : uv) low = glm::min(low, p), high = glm::max(high, p);
    return std::max(high.x - low.x, high.y - low.y);
}

double longest_move(const std::vector<vec2>& a, const std::vector<vec2>& b)
{
    double most = 0;
    for (std::size_t v = 0; v < a.size(); ++v) most = std::max(most, glm::distance(a[v], b[v]));
    return most;
}

bool same_bits(double a, double b)
{
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// Everything that a session promises of what it returns.
void check_promises(const mesh<triangle>& m, const session<triangle>& s, const session_result<triangle>& r)
{
    REQUIRE(r);
    CHECK(certify<2>(m.cells(), std::span<const vec2>(r.x)));
    CHECK(test::wound_vertices(m, r.x).empty());
    CHECK(r.report.flips.flipped + r.report.flips.branched == 0);
    CHECK(s.x() == r.x);
    bool held = true;
    for (const auto& [v, pin] : s.constraints().pins())
        for (int k = 0; k < 2; ++k)
            if ((pin.held >> k & 1u) != 0) held = held && same_bits(r.x[static_cast<std::size_t>(v)][k], pin.value[k]);
    CHECK(r.report.pins_held == held);
    CHECK((r.report.farthest >= 0) == !held);
    CHECK((r.report.distance > 0) == !held);
    if (r.report.converged) CHECK(held);
}

/// The vertex inside that is nearest to the middle of a map, and two on its boundary.
struct handles
{
    idx middle = 0, left, right;

    handles(const mesh<triangle>& m, const std::vector<vec2>& uv)
    {
        const auto loop = boundary_loops(m).front();
        left = loop[0];
        right = loop[loop.size() / 2];
        const auto flags = boundary_flags(uv.size(), boundary_loops(m));
        vec2 centre(0);
        for (const vec2& p : uv) centre += p / double(uv.size());
        double nearest = INFINITY;
        for (std::size_t v = 0; v < uv.size(); ++v)
            if (flags[v] == 0 && glm::distance(uv[v], centre) < nearest)
                nearest = glm::distance(uv[v], centre), middle = static_cast<idx>(v);
    }
};

vec2 at(const session<triangle>& s, idx v)
{
    return s.x()[static_cast<std::size_t>(v)];
}

TEST_CASE("session: the first map is that of parameterize()")
{
    queue q(test::shared_context());
    const auto m = bump();
    session s(q, m);
    CHECK(s.x().empty());
    const auto first = s.solve();
    const auto same = parameterize(q, m);
    check_promises(m, s, first);
    CHECK(first.x == same.uv);
    CHECK(first.report.converged);
    CHECK(first.report.energy == same.report.solve.value);
    const auto again = s.solve();
    CHECK(again.x == first.x);
    CHECK(again.report.steps == 0);
    CHECK(again.report.counters.launches == 0);
}

TEST_CASE("session: a pin that is dragged holds bit for bit in valid maps that do not jump, and ends where a map from "
          "scratch does")
{
    queue q(test::shared_context());
    for (const auto& m : {bump(), spiral(), coarse()})
    {
        CAPTURE(m.cells().size());
        session s(q, m);
        REQUIRE(s.solve());
        const handles h(m, s.x());
        const double size = extent(s.x());
        const vec2 from = at(s, h.middle);
        s.pin(h.left, at(s, h.left)).pin(h.right, at(s, h.right)).pin(h.middle, from);
        for (int frame = 1; frame <= 12; ++frame)
        {
            CAPTURE(frame);
            const auto before = s.x();
            const vec2 to = from + 0.004 * size * vec2(frame, frame / 2.0);
            const auto r = s.pin(h.middle, to).solve({.steps = 2});
            check_promises(m, s, r);
            CHECK(r.report.steps <= 2);
            CHECK(r.report.pins_held);
            CHECK(longest_move(before, r.x) < 0.05 * size);
        }
        const auto rest = s.solve();
        check_promises(m, s, rest);
        CHECK(rest.report.converged);
        const auto scratch = parameterize(q, m, {.constraints = s.constraints()});
        REQUIRE(scratch);
        CHECK(rest.report.energy == doctest::Approx(scratch.report.solve.value).epsilon(1e-3));
    }
}

TEST_CASE("session: where pins are changes nothing but numbers, and who is pinned no more than lists")
{
    queue q(test::shared_context());
    const auto m = bump();
    session s(q, m);
    s.solve();
    const handles h(m, s.x());
    const vec2 from = at(s, h.middle);
    s.pin(h.left, at(s, h.left)).pin(h.right, at(s, h.right)).pin(h.middle, from + vec2(0.01, 0)).solve();
    s.release(h.right).pin(h.middle, from).solve(); // what drivers and caches meet late
    const auto all = q.allocated();
    const std::size_t map_bytes = 2 * sizeof(double) * m.points().size();
    for (int frame = 1; frame <= 3; ++frame)
    {
        const auto moved = s.pin(h.middle, from + vec2(0.005 * frame, 0)).solve({.steps = 1});
        CHECK(moved.report.pins_held);
        CHECK(moved.report.counters.builds == 0);
        CHECK(moved.report.counters.bytes_written < map_bytes / 4);
        CHECK(moved.report.seconds.start == 0);
        const auto more = s.pin(h.right, at(s, h.right)).solve({.steps = 1});
        CHECK(more.report.counters.builds == 0);
        CHECK(more.report.counters.bytes_written < map_bytes / 4);
        s.release(h.right);
    }
    CHECK(q.allocated() < all + all / 20);
}

TEST_CASE("session: a map that is only carried off stays congruent, however far")
{
    queue q(test::shared_context());
    const auto m = bump();
    session s(q, m);
    const auto first = s.solve();
    const handles h(m, s.x());
    const vec2 way = 20 * extent(s.x()) * vec2(1, -0.5);
    const auto r = s.pin(h.middle, at(s, h.middle) + way).solve();
    check_promises(m, s, r);
    CHECK(r.report.converged);
    CHECK(r.report.energy == doctest::Approx(first.report.energy).epsilon(1e-6));
    auto moved = first.x;
    for (vec2& p : moved) p += way;
    CHECK(longest_move(moved, r.x) < 0.05 * extent(first.x)); // it may turn
}

TEST_CASE("session: what the budget leaves is told and done by the next calls; released pins let the map go back")
{
    queue q(test::shared_context());
    const auto m = bump();
    session s(q, m);
    const double rest = s.solve().report.energy;
    const handles h(m, s.x());
    const double size = extent(s.x());
    const vec2 to = at(s, h.middle) + vec2(0.3 * size, 0.1 * size);
    s.pin(h.left, at(s, h.left)).pin(h.right, at(s, h.right)).pin(h.middle, to);
    auto r = s.solve({.steps = 1});
    check_promises(m, s, r);
    CHECK(!r.report.pins_held);
    CHECK(!r.report.converged);
    CHECK(r.report.farthest == h.middle);
    CHECK(r.report.distance == doctest::Approx(glm::distance(at(s, h.middle), to)));
    int calls = 1;
    for (; !r.report.pins_held && calls < 100; ++calls)
    {
        const double before = r.report.distance;
        r = s.solve({.steps = 1});
        check_promises(m, s, r);
        CHECK(r.report.distance <= before);
    }
    CHECK(calls < 100);
    CHECK(s.solve().report.converged);
    CHECK(s.solve().report.energy > rest);

    s.release(h.middle).release(h.left).release(h.right);
    r = s.solve();
    check_promises(m, s, r);
    CHECK(r.report.converged);
    CHECK(r.report.energy == doctest::Approx(rest).epsilon(1e-5));
}

TEST_CASE("session: a time limit ends it; the map is valid and the next call goes on")
{
    queue q(test::shared_context());
    const auto m = bump();
    session s(q, m);
    CHECK(s.solve({.time = std::chrono::duration<double>(0)}).report.outcome == outcome::stopped);
    CHECK(s.x().empty());
    REQUIRE(s.solve());
    const handles h(m, s.x());
    s.pin(h.left, at(s, h.left)).pin(h.right, at(s, h.right));
    const auto r = s.pin(h.middle, at(s, h.middle) + vec2(0.05, 0)).solve({.time = std::chrono::duration<double>(0)});
    check_promises(m, s, r);
    CHECK(r.report.steps == 1);
    CHECK(s.solve().report.converged);
}

TEST_CASE("session: a pin outside of a pinned boundary is proved to be so; the map stays near, and comes back")
{
    queue q(test::shared_context());
    const auto m = bump();
    session s(q, m);
    const auto first = s.solve();
    const handles h(m, s.x());
    const auto loop = boundary_loops(m).front();
    for (const idx v : loop) s.pin(v, at(s, v));
    const vec2 home = at(s, h.middle);
    auto r = s.pin(h.middle, home + vec2(3 * extent(first.x), 0)).solve();
    check_promises(m, s, r);
    CHECK(!r.report.pins_held);
    CHECK(!r.report.converged);
    CHECK(r.report.reason.find(std::to_string(h.middle)) != std::string::npos);
    CHECK(std::find(r.report.ids.begin(), r.report.ids.end(), h.middle) != r.report.ids.end());
    CHECK(r.report.energy < 4 * first.report.energy);
    for (const idx v : loop) CHECK(at(s, v) == s.constraints().pins().at(v).value); // those hold
    r = s.pin(h.middle, home).solve();
    check_promises(m, s, r);
    CHECK(r.report.reason.empty());
    CHECK(r.report.converged);
    CHECK(r.report.energy == doctest::Approx(first.report.energy).epsilon(1e-5));
}

TEST_CASE("session: a pin in another one's way stops it in a map of bounded energy, and with time it gets past")
{
    queue q(test::shared_context());
    const auto m = bump();
    session s(q, m);
    const double free = s.solve().report.energy;
    const handles h(m, s.x());
    const double size = extent(s.x());
    const vec2 from = at(s, h.middle);
    idx other = h.left;
    for (idx v = 0; v < m.vertex_count(); ++v)
        if (v != h.middle && std::abs(glm::distance(at(s, v), from) - 0.15 * size) <
                                 std::abs(glm::distance(at(s, other), from) - 0.15 * size))
            other = v;
    const vec2 way = at(s, other) - from;
    s.pin(h.left, at(s, h.left)).pin(h.right, at(s, h.right)).pin(other, at(s, other));
    session_result<triangle> r;
    for (int frame = 1; frame <= 24; ++frame)
    {
        r = s.pin(h.middle, from + way * (frame / 14.0)).solve({.steps = 4});
        check_promises(m, s, r);
        CHECK(r.report.energy < 100 * free);
    }
    for (int call = 0; call < 5 && !r.report.pins_held; ++call) r = s.solve();
    check_promises(m, s, r);
    CHECK(r.report.pins_held);
    CHECK(at(s, other) == from + way);
}

TEST_CASE("session: many pins are moved together; coordinates alone, springs and a fixed boundary hold, too")
{
    queue q(test::shared_context());
    const auto m = bump();
    const auto free = parameterize(q, m);
    session s(q, m, {.boundary = boundary_mode::fixed, .initial = free.uv});
    const auto first = s.solve();
    check_promises(m, s, first);
    const auto loop = boundary_loops(m).front();
    const auto flags = boundary_flags(first.x.size(), boundary_loops(m));
    const vec2 centre = at(s, handles(m, first.x).middle);
    std::vector<idx> inside;
    for (std::size_t v = 0; v < flags.size(); v += 9)
        if (flags[v] == 0 && glm::distance(first.x[v], centre) < 0.3 * extent(first.x))
            inside.push_back(static_cast<idx>(v));
    REQUIRE(inside.size() > 5);
    const idx slider = inside.back(), drawn = inside[inside.size() - 2];
    inside.resize(inside.size() - 2);
    s.move(inside,
           [&](const vec2& p)
           {
               const vec2 d = p - centre;
               return centre + vec2(0.9 * d.x - 0.1 * d.y, 0.9 * d.y + 0.1 * d.x);
           });
    s.pin_u(slider, at(s, slider).x + 0.02).spring(drawn, at(s, drawn) + vec2(0, 0.1), 50);
    auto r = s.solve();
    check_promises(m, s, r);
    CAPTURE(r.report.reason);
    CHECK(r.report.converged);
    for (const idx v : loop) CHECK(at(s, v) == first.x[static_cast<std::size_t>(v)]);
    const double drawn_to = at(s, drawn).y;
    CHECK(drawn_to > first.x[static_cast<std::size_t>(drawn)].y);

    r = s.pin_u(slider, at(s, slider).x - 0.03).spring(drawn, at(s, drawn) + vec2(0, 0.1), 500).solve();
    check_promises(m, s, r);
    CHECK(at(s, drawn).y > drawn_to);
    for (const idx v : inside) s.release(v);
    r = s.release(slider).release(drawn).solve();
    check_promises(m, s, r);
    CHECK(longest_move(r.x, first.x) < 1e-3);
}

TEST_CASE("session: params are those of parameterize(): first pins, energy, weights, precision, unit square")
{
    queue q(test::shared_context());
    const auto m = bump();
    const auto free = parameterize(q, m);
    const handles h(m, free.uv);
    const auto place = [&](idx v) { return free.uv[static_cast<std::size_t>(v)]; };
    auto pins = taut::constraints(m).pin(h.left, place(h.left)).pin(h.middle, place(h.middle) + vec2(0.02, 0.01));
    for (const auto& params : {parameterize_params{.constraints = pins},
                               parameterize_params{.energy = 0.5 * energy::isometric{} + 0.5 * energy::shape{},
                               .weights = energy::weighting::uniform,
                               .constraints = pins,
                               .precision = precision::fp64},
                               parameterize_params{.constraints = pins, .precision = precision::fp32}})
    {
        session s(q, m, params);
        const auto first = s.solve();
        check_promises(m, s, first);
        CHECK(first.report.pins_held);
        CHECK(first.report.energy == doctest::Approx(parameterize(q, m, params).report.solve.value).epsilon(1e-6));
        const auto r = s.pin(h.middle, place(h.middle)).solve();
        check_promises(m, s, r);
        CHECK(r.report.pins_held);
        auto moved = params;
        moved.constraints = s.constraints();
        CHECK(r.report.energy == doctest::Approx(parameterize(q, m, moved).report.solve.value).epsilon(1e-5));
    }
    session square(q, m, {.placement = placement::unit_square});
    const auto first = square.solve();
    CHECK(extent(first.x) == doctest::Approx(1));
    const auto r = square.pin(h.middle, at(square, h.middle) + vec2(0.25, 0)).solve();
    check_promises(m, square, r);
    CHECK(r.report.converged);
    CHECK(extent(r.x) == doctest::Approx(1).epsilon(1e-2));
    CHECK(r.report.energy == doctest::Approx(first.report.energy).epsilon(1e-6));
}

TEST_CASE("session: an observer sees maps of the way and can end the call")
{
    queue q(test::shared_context());
    const auto m = bump();
    int maps = 0, asked = 0;
    bool go_on = true;
    session s(q, m, {},
              {.observer = [&](const progress& p)
               {
                   ++asked;
                   if (p.coordinates)
                   {
                       CHECK(certify<2>(m.cells(), std::span<const vec2>(p.coordinates())));
                       ++maps;
                   }
                   return go_on;
               }});
    REQUIRE(s.solve());
    CHECK(maps > 0);
    const handles h(m, s.x());
    s.pin(h.left, at(s, h.left)).pin(h.right, at(s, h.right));
    maps = asked = 0;
    s.pin(h.middle, at(s, h.middle) + vec2(0.3, 0)).solve();
    CHECK(maps > 0);
    go_on = false;
    maps = asked = 0;
    const auto r = s.pin(h.middle, at(s, h.middle) + vec2(0.4, 0)).solve();
    check_promises(m, s, r);
    CHECK(!r.report.converged);
    CHECK(asked <= 3);
}

TEST_CASE("session: what cannot be is refused, and everything is as before")
{
    queue q(test::shared_context());
    const auto m = bump();
    session s(q, m);
    const auto refused = [&](auto&& call, constraint_error::fault_type fault)
    {
        try
        {
            call();
            FAIL("accepted");
        }
        catch (const constraint_error& e)
        {
            CHECK(e.fault() == fault);
        }
    };
    const std::vector<idx> some{0, 1};
    const auto shift = [](const vec2& p) { return p + vec2(1, 0); };
    refused([&] { s.move(some, shift); }, constraint_error::no_position);
    const auto first = s.solve();
    const auto n = m.vertex_count();
    refused([&] { s.pin(n, {0, 0}); }, constraint_error::out_of_range);
    refused([&] { s.pin(0, {NAN, 0}); }, constraint_error::not_finite);
    refused([&] { s.pin(0, 2, 0.0); }, constraint_error::no_coordinate);
    refused([&] { s.release(-1); }, constraint_error::out_of_range);
    refused([&] { s.spring(0, {0, 0}, -1); }, constraint_error::bad_weight);
    refused([&] { s.move(some, std::vector<vec2>{{0, 0}}); }, constraint_error::wrong_count);
    refused([&] { s.move(std::vector<idx>{0, n}, shift); }, constraint_error::out_of_range);
    CHECK(s.constraints().empty());
    CHECK_THROWS_AS(s.solve({.steps = 0}), parameter_error);
    CHECK_THROWS_AS(s.solve({.time = std::chrono::duration<double>(-1)}), parameter_error);
    CHECK(s.solve().x == first.x);
    CHECK_THROWS_AS(session(q, m, {.solve = {.method = solve::method::lbfgs}}), parameter_error);
    CHECK_THROWS_AS(session(q, test::moebius(5)), mesh_error);
    const auto larger = test::grid(40, 40);
    CHECK_THROWS_AS(session(q, m, {.constraints = taut::constraints(larger).pin(1600, {0, 0})}), constraint_error);
}

TEST_CASE("session: restored, it has the map and the constraints of before, and goes on from there")
{
    const auto surface = bump();
    queue q(test::shared_context());
    session s(q, surface);
    CHECK_THROWS_WITH_AS(s.restore({}, {}), doctest::Contains("no map yet"), parameter_error);
    REQUIRE(s.solve());
    const idx v = surface.vertex_count() / 2;
    const auto asked = s.constraints();
    const auto x = s.x();
    const vec2 there = x[static_cast<std::size_t>(v)] + vec2(0.1 * extent(x), 0);
    REQUIRE(s.pin(v, there).solve().report.pins_held);
    REQUIRE(s.x() != x);

    s.restore(asked, x);
    CHECK(s.x() == x);
    CHECK(s.constraints().empty());
    const auto back = s.solve();
    CHECK(back.report.converged);
    CHECK(longest_move(back.x, x) < 1e-4 * extent(x));

    auto folded = x;
    folded[static_cast<std::size_t>(v)] += vec2(3 * extent(x), 0);
    CHECK_THROWS_WITH_AS(s.restore(asked, folded), doctest::Contains("not injective"), parameter_error);
    CHECK_THROWS_AS(s.restore(asked, {}), parameter_error);
    CHECK(s.x() == back.x);

    const auto pinned = s.pin(v, there).solve();
    s.restore(asked, x);
    s.restore(s.constraints(), x).pin(v, there); // and what is asked then holds
    CHECK(s.solve().x[static_cast<std::size_t>(v)] == there);
    CHECK(pinned.x[static_cast<std::size_t>(v)] == there);
}

TEST_CASE("session: infeasible first pins are no map but a proof; once they are changed there is one")
{
    queue q(test::shared_context());
    const auto m = bump();
    session s(q, m);
    const auto& t = m.cells()[17];
    s.pin(t[0], {0, 0}).pin(t[1], {0, 1}).pin(t[2], {1, 0});
    const auto r = s.solve();
    CHECK(!r);
    CHECK(r.report.outcome == outcome::infeasible);
    CHECK(r.x.empty());
    CHECK(!r.report.reason.empty());
    const auto good = s.release(t[2]).solve();
    check_promises(m, s, good);
    CHECK(good.report.pins_held);
}

} // namespace
