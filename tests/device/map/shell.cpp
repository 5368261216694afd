// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>

#include <taut/certify.hpp>
#include <taut/deform.hpp>
#include <taut/impl/core/exact/collapses.hpp>
#include <taut/rigid_motion.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using taut::idx;

/// A flat strip, four times as long (along x) as wide.
mesh<triangle> strip()
{
    const int n = test::sized(10, 5);
    const auto m = test::grid(4 * n, n);
    auto points = m.points();
    for (vec3& p : points) p.x *= 4;
    return {std::move(points), m.cells()};
}

/// Vertices of the left and right ends.
std::vector<idx> end_of(const mesh<triangle>& m, bool right)
{
    double most = 0;
    for (const vec3& p : m.points()) most = std::max(most, p.x);
    std::vector<idx> ids;
    for (idx v = 0; v < m.vertex_count(); ++v)
        if (m.points()[static_cast<std::size_t>(v)].x == (right ? most : 0)) ids.push_back(v);
    return ids;
}

double length_of(const mesh<triangle>& m)
{
    return m.points()[static_cast<std::size_t>(end_of(m, true)[0])].x;
}

/// Root of the mean square of the edges' relative changes.
double edge_change(const mesh<triangle>& m, const std::vector<vec3>& x)
{
    double sum = 0;
    for (const auto& t : m.cells())
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto a = static_cast<std::size_t>(t[k]), b = static_cast<std::size_t>(t[(k + 1) % 3]);
            const double ratio = glm::distance(x[a], x[b]) / glm::distance(m.points()[a], m.points()[b]);
            sum += (ratio - 1) * (ratio - 1);
        }
    return std::sqrt(sum / (3.0 * static_cast<double>(m.cells().size())));
}

/// What is promised of every shape of a shell.
void check_shell(const mesh<triangle>& m, const constraints<hinge>& pins, const session_result<hinge>& r)
{
    REQUIRE(r);
    CHECK(r.x.size() == m.points().size());
    CHECK(certify_surface(m.cells(), m.points(), r.x));
    bool exact = true;
    for (const auto& [v, pin] : pins.pins())
        for (int k = 0; k < 3; ++k)
            if ((pin.held >> k & 1u) != 0)
                exact = exact && std::memcmp(&r.x[static_cast<std::size_t>(v)][k], &pin.value[k], sizeof(double)) == 0;
    CHECK(exact);
    CHECK(r.report.pins_held);
}

rigid_motion<3> turn_about(const vec3& at, const vec3& axis, double angle)
{
    return {.from = at, .to = at, .axis = axis, .angle = angle};
}

} // namespace

TEST_CASE("shell: without pins the shape at rest is returned, and one that was moved is carried along")
{
    const thin_shell shell(test::bumpy(6));
    const auto& m = shell.surface();
    queue q(test::shared_context());
    const auto still = deform(q, shell, {});
    check_shell(m, {}, still);
    CHECK(edge_change(m, still.x) < 1e-6);

    // One vertex alone takes all along, however far.
    const auto one = taut::constraints(shell.hinges()).pin(3, {5, 0, 2});
    const auto carried = deform(q, shell, {.constraints = one});
    check_shell(m, one, carried);
    CHECK(edge_change(m, carried.x) < 1e-3);

    // Three vertices, rigidly.
    const auto away = turn_about({0.5, 0.2, 0}, glm::normalize(vec3(1, 1, 2)), 1.2);
    auto pins = taut::constraints(shell.hinges());
    for (const idx v : {0, 7, m.vertex_count() - 1})
        pins.pin(v, away(m.points()[static_cast<std::size_t>(v)]) + vec3(1, 2, 3));
    const auto moved = deform(q, shell, {.constraints = pins});
    check_shell(m, pins, moved);
    CHECK(moved.report.converged);
    CHECK(edge_change(m, moved.x) < 1e-4);
}

TEST_CASE("shell: a strip that is bent to a ring keeps its edges, and one that is twisted or lifted its triangles")
{
    const thin_shell shell(strip());
    const auto& m = shell.surface();
    const double length = length_of(m);
    queue q(test::shared_context());
    const auto left = end_of(m, false), right = end_of(m, true);

    // Both ends stand up at the place where the ring closes, a little apart.
    const double radius = length / (2 * std::numbers::pi), half = 0.9 * std::numbers::pi;
    session<hinge> s(q, shell, {.thickness = 0.1 * length});
    const vec3 middle(length / 2, 0, 0);
    const int parts = 6;
    for (int part = 1; part <= parts; ++part)
    {
        const double angle = half * part / parts, r = length / (2 * angle);
        for (const auto* end : {&left, &right})
            for (const idx v : *end)
            {
                const vec3 p = m.points()[static_cast<std::size_t>(v)];
                const double a = (end == &left ? -1 : 1) * angle;
                s.pin(v, {middle.x + r * std::sin(a), p.y, r * (1 - std::cos(a))});
            }
        const auto bent = s.solve();
        check_shell(m, s.constraints(), bent);
    }
    CHECK(s.solve().report.converged);
    CHECK(edge_change(m, s.x()) < 0.05);
    double highest = 0;
    for (const vec3& p : s.x()) highest = std::max(highest, p.z);
    CHECK(highest > 1.5 * radius);

    for (const bool twist : {true, false})
    {
        auto pins = taut::constraints(shell.hinges());
        const auto quarter = turn_about({length, 0, 0}, {1, 0, 0}, std::numbers::pi / 2);
        for (const idx v : left) pins.pin(v, m.points()[static_cast<std::size_t>(v)]);
        for (const idx v : right)
        {
            const vec3 p = m.points()[static_cast<std::size_t>(v)];
            pins.pin(v, twist ? quarter(p) : p + vec3(0, 0, length / 3));
        }
        for (const precision how : {precision::automatic, precision::fp64})
        {
            const auto r = deform(q, shell, {.constraints = pins, .precision = how});
            check_shell(m, pins, r);
            CHECK(r.report.converged);
            CHECK(edge_change(m, r.x) < 0.15);
        }
    }
}

TEST_CASE(
    "shell: the surface may be closed, with handles, of several parts, and a session follows a drag frame by frame")
{
    const thin_shell shell(test::torus(test::sized(16, 10), false));
    const auto& m = shell.surface();
    queue q(test::shared_context());
    session<hinge> s(q, shell);
    const idx held = 0, dragged = m.vertex_count() / 2;
    const vec3 start = m.points()[static_cast<std::size_t>(dragged)];
    s.pin(held, m.points()[0]).pin(dragged, start);
    double farthest = 0;
    auto before = s.solve().x;
    for (int frame = 1; frame <= 20; ++frame)
    {
        const auto r = s.pin(dragged, start + 0.02 * frame * vec3(0, 1, 1)).solve({.steps = 3});
        REQUIRE(r);
        CHECK(certify_surface(m.cells(), m.points(), r.x));
        for (std::size_t v = 0; v < r.x.size(); ++v) farthest = std::max(farthest, glm::distance(r.x[v], before[v]));
        before = r.x;
    }
    CHECK(farthest < 0.2); // no jumps
    check_shell(m, s.constraints(), s.solve());
}

TEST_CASE("shell: handles that turn far arrive in calls of a step each")
{
    const thin_shell shell(strip());
    const auto& m = shell.surface();
    const double length = length_of(m);
    queue q(test::shared_context());
    session<hinge> s(q, shell, {.thickness = 0.1 * length});
    for (const idx v : end_of(m, false)) s.pin(v, m.points()[static_cast<std::size_t>(v)]);
    s.solve();
    const auto away = turn_about({0.8 * length, 0, 0}, {0, 1, 0}, -0.45 * std::numbers::pi);
    for (idx v = 0; v < m.vertex_count(); ++v) // a body of triangles
        if (const vec3 p = m.points()[static_cast<std::size_t>(v)]; p.x > 0.8 * length) s.pin(v, away(p));
    session_result<hinge> r;
    int calls = 0;
    do r = s.solve({.steps = 1});
    while (!r.report.pins_held && ++calls < 40);
    check_shell(m, s.constraints(), r);
}

TEST_CASE("shell: what cannot be a shell is refused")
{
    CHECK_THROWS_WITH_AS(thin_shell{test::single_triangle()}, doctest::Contains("without a neighbour"), mesh_error);
    CHECK_THROWS_AS(thin_shell{test::three_on_an_edge()}, mesh_error);
    CHECK_THROWS_AS(thin_shell(test::moebius(8)), mesh_error);

    const thin_shell shell(test::grid(3, 3));
    queue q(test::shared_context());
    for (const double thickness : {0.0, -1.0, std::nan("")})
        CHECK_THROWS_WITH_AS(session<hinge>(q, shell, {.thickness = thickness}), doctest::Contains("thickness"),
                             parameter_error);
    CHECK_THROWS_AS(deform(q, shell, {.initial = {vec3(0.0)}}), parameter_error);

    const std::vector<vec3> a_point(shell.surface().points().size(), vec3(0.0));
    const auto r = deform(q, shell, {.initial = a_point});
    CHECK_FALSE(r);
    CHECK(r.report.outcome == outcome::gave_up);
    CHECK(r.report.reason.find("collapsed") != std::string::npos);
    CHECK(r.x.empty());
}
