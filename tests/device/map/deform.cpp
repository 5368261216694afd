// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>

#include <taut/deform.hpp>
#include <taut/energies.hpp>
#include <taut/rigid_motion.hpp>
#include <taut/smooth.hpp>

namespace
{

using namespace taut;
using taut::idx;

/// A bar of n tetrahedron cubes across, three times as long.
mesh<tetrahedron> bar()
{
    const auto m = test::jittered_cube(test::sized(5, 3), 11);
    auto points = m.points();
    for (vec3& p : points) p.z *= 3;
    return {std::move(points), m.cells()};
}

/// So many cubes, each of n^3 of them, on top of each other.
mesh<tetrahedron> tower(int n, int cubes)
{
    const auto cube = test::cube(n);
    const auto layer = static_cast<std::size_t>((n + 1) * (n + 1));
    std::vector<vec3> points;
    std::vector<mesh<tetrahedron>::cell> cells;
    for (int k = 0; k < cubes; ++k)
    {
        for (auto t : cube.cells())
        {
            for (idx& v : t) v += k * n * static_cast<idx>(layer);
            cells.push_back(t);
        }
        for (std::size_t v = k > 0 ? layer : 0; v < cube.points().size(); ++v)
            points.push_back(cube.points()[v] + vec3(0, 0, k));
    }
    return {std::move(points), std::move(cells)};
}

std::vector<idx> where(const mesh<tetrahedron>& m, auto&& inside)
{
    std::vector<idx> ids;
    for (idx v = 0; v < m.vertex_count(); ++v)
        if (inside(m.points()[static_cast<std::size_t>(v)])) ids.push_back(v);
    return ids;
}
std::vector<idx> bottom(const mesh<tetrahedron>& m)
{
    return where(m, [](const vec3& p) { return p.z == 0; });
}
std::vector<idx> top(const mesh<tetrahedron>& m)
{
    return where(m, [](const vec3& p) { return p.z == 3; });
}

/// What is promised of every shape that comes back.
template <class Element>
void check_promises(const mesh<Element>& m, const taut::constraints<Element>& pins, const session_result<Element>& r)
{
    constexpr int D = Element::dimension;
    REQUIRE(r);
    CHECK(certify<D>(m.cells(), std::span<const vec<D>>(r.x)));
    bool exact = true;
    for (const auto& [v, pin] : pins.pins())
        for (int k = 0; k < D; ++k)
            if ((pin.held >> k & 1u) != 0)
                exact = exact && std::memcmp(&r.x[static_cast<std::size_t>(v)][k], &pin.value[k], sizeof(double)) == 0;
    CHECK(exact);
    CHECK(r.report.pins_held);
}

rigid_motion<3> turn(double angle, const vec3& axis = {0, 0, 1})
{
    return {.from = vec3(0.5, 0.5, 3), .to = vec3(0.5, 0.5, 3), .axis = axis, .angle = angle};
}

} // namespace

TEST_CASE("deform: a bar is twisted, stretched and bent without an inverted element, and converges")
{
    const auto m = bar();
    queue q(test::shared_context());
    const auto full = turn(std::numbers::pi);
    const auto bent = turn(std::numbers::pi / 2, {1, 0, 0});
    const auto wanted = [&](int kind, const vec3& p)
    {
        return kind == 0   ? full(p)
               : kind == 1 ? p + vec3(0, 0, 2)
               : kind == 2 ? p - vec3(0, 0, 1.2)
                           : bent(p) - vec3(0, 1, 1);
    };
    for (int kind = 0; kind < 4; ++kind)
    {
        CAPTURE(kind);
        deform_params<tetrahedron> params{.constraints = taut::constraints(m).fix(bottom(m)).move(
                                              top(m), [&](const vec3& p) { return wanted(kind, p); })};
        const auto r = deform(q, m, params);
        check_promises(m, params.constraints, r);
        CHECK(r.report.converged);
        CHECK(r.report.gradient < 1e-6);
        CHECK(r.report.energy > 2);
    }
}

TEST_CASE("deform: handles that turn are brought to their places at once, and what that squeezes is mended by itself")
{
    const auto m = bar();
    queue q(test::shared_context());
    const auto stage = [](const session_result<tetrahedron>& r, const std::string& name)
    {
        const auto& all = r.report.stages;
        const auto found = std::find_if(all.begin(), all.end(), [&](const auto& s) { return s.stage == name; });
        return found == all.end() ? nullptr : &*found;
    };
    deform_params<tetrahedron> params;
    const auto twist = turn(std::numbers::pi / 2), bend = turn(std::numbers::pi / 2, {1, 0, 0});
    for (const bool twisted : {true, false})
    {
        params.constraints = taut::constraints(m).fix(bottom(m)).move(
            top(m), [&](const vec3& p) { return twisted ? twist(p) : bend(p) - vec3(0, 1, 1); });
        const auto r = deform(q, m, params);
        check_promises(m, params.constraints, r);
        CHECK(r.report.converged);
        REQUIRE(stage(r, "draft"));
        CHECK(stage(r, "draft")->stop == "injective");
        CHECK(!stage(r, "follow"));
        CHECK(r.report.steps < 10);
    }

    // Around a small handle elements shrink or turn over.
    const auto cube = test::jittered_cube(14, 11);
    const auto handle =
        where(cube, [](const vec3& p) { return p.z == 1 && glm::distance(p, vec3(0.5, 0.5, 1)) < 0.16; });
    deform_params<tetrahedron> local;
    local.constraints =
        taut::constraints(cube)
            .fix(bottom(cube))
            .move(handle, rigid_motion<3>{.from = vec3(0.5, 0.5, 1), .to = vec3(0.5, 0.5, 1), .angle = 1.5});
    const auto sharp = deform(q, cube, local);
    check_promises(cube, local.constraints, sharp);
    CHECK(sharp.report.converged);
    REQUIRE(stage(sharp, "draft"));
    CHECK(stage(sharp, "draft")->stop == "injective");
    CHECK(stage(sharp, "draft")->iterations > 0);
    CHECK(stage(sharp, "draft")->vertices < cube.points().size());

    // What turns as a whole is where it should be.
    params.constraints = taut::constraints(m).move(bottom(m), turn(1, {0, 1, 0})).move(top(m), turn(1, {0, 1, 0}));
    const auto whole = deform(q, m, params);
    check_promises(m, params.constraints, whole);
    CHECK(whole.report.energy == doctest::Approx(2));
    CHECK(whole.report.steps <= 2);

    // With slides steps lead.
    params.constraints = taut::constraints(m).fix(bottom(m)).move(top(m), turn(1));
    const auto inner = where(m, [](const vec3& p) { return glm::distance(p, vec3(0.5, 0.5, 1.5)) < 0.6; });
    REQUIRE(!inner.empty());
    params.slides = {slide<3>::across(inner[0], {0, 1, 0})};
    const auto sliding = deform(q, m, params);
    check_promises(m, params.constraints, sliding);
    CHECK(!stage(sliding, "draft"));
}

TEST_CASE("deform: slender volumes are drafted on coarser ones, so that few steps are left")
{
    constexpr int length = 90;
    const auto m = tower(4, length);
    queue q(test::shared_context());
    deform_params<tetrahedron> params;
    const auto end = where(m, [](const vec3& p) { return p.z == length; });
    const auto steps = [&](const auto& motion)
    {
        params.constraints = taut::constraints(m).fix(bottom(m)).move(end, motion);
        const auto r = deform(q, m, params);
        check_promises(m, params.constraints, r);
        CHECK(r.report.converged);
        return r.report.steps;
    };
    const auto turned = turn(std::numbers::pi / 2, {1, 0, 0});
    const auto bend = [&](const vec3& p)
    { return turned(p - vec3(0, 0, length - 3)) + vec3(0, -0.5 * length, 0.7 * length - 3); };
    CHECK(steps(bend) <= 8); // 59 from a draft of the mesh itself

    // Nothing turns, but steps get nowhere near at once.
    CHECK(steps([](const vec3& p) { return p + vec3(0, 5, -70); }) <= 200); // 319 where it is led
}

TEST_CASE("deform: an energy that is 0 at rest takes steps from there, in any precision")
{
    const auto m = bar();
    queue q(test::shared_context());
    for (const precision how : {precision::fp64, precision::mixed})
        for (const double poisson : {0.3, 0.45})
        {
            CAPTURE(poisson);
            deform_params<tetrahedron> params{.energy = energy::neo_hookean{poisson},
                                              .constraints = taut::constraints(m).fix(bottom(m)).move(
                                                  top(m), [](const vec3& p) { return p + vec3(0, 0, 0.5); }),
                                              .precision = how};
            const auto r = deform(q, m, params);
            check_promises(m, params.constraints, r);
            CHECK(r.report.notes.empty()); // it was not untangled
            CHECK(r.report.converged);
            CHECK(r.report.gradient < 1e-6);
            CHECK(r.report.steps < 12);
            const auto lame = energy::neo_hookean::of_poisson(poisson); // as numbers that kernels are given
            params.energy = {energy::neo_hookean_of_parameters{}, {lame.begin(), lame.end()}};
            CHECK(deform(q, m, params).report.energy == doctest::Approx(r.report.energy).epsilon(1e-5));
        }
}

TEST_CASE("deform: where steps in float lead no further the shape goes on in double")
{
    const auto m = bar();
    queue q(test::shared_context());
    if (!q.device().has_fp64()) return;
    // Squeezed across by 1e9: in float determinants are nothing but rounding, and no step gains anything.
    deform_params<tetrahedron> params;
    params.constraints = constraints(m).pin(0, m.points()[0]);
    const vec3 across = glm::normalize(vec3(1, 2, 3));
    for (const vec3& p : m.points()) params.initial.push_back(p - (1 - 1e-9) * glm::dot(p, across) * across);
    params.precision = precision::mixed;
    CHECK(!deform(q, m, params).report.converged);
    params.precision = precision::automatic;
    const auto r = deform(q, m, params);
    check_promises(m, params.constraints, r);
    CHECK(r.report.converged);
    CHECK(r.report.energy == doctest::Approx(2));
    const auto& notes = r.report.notes;
    CHECK(std::any_of(notes.begin(), notes.end(),
                      [](const std::string& note) { return note.find("in double") != std::string::npos; }));
}

TEST_CASE("deform: what is bent is no better for starting elsewhere, and the shape at rest costs nothing")
{
    const auto m = bar();
    queue q(test::shared_context());
    deform_params<tetrahedron> params{.constraints =
                                          taut::constraints(m).fix(bottom(m)).move(top(m), turn(0.7, {1, 0, 0}))};
    const auto direct = deform(q, m, params);
    deform_params<tetrahedron> half = params;
    half.constraints = taut::constraints(m).fix(bottom(m)).move(top(m), turn(0.35, {1, 0, 0}));
    params.initial = deform(q, m, half).x;
    const auto second = deform(q, m, params);
    check_promises(m, params.constraints, second);
    CHECK(second.report.energy == doctest::Approx(direct.report.energy).epsilon(1e-7));

    // The deformed shape with the first one as its rest goes back.
    deform_params<tetrahedron> back{
        .constraints = taut::constraints(m).fix(bottom(m)), .initial = direct.x, .solve = {.gradient_tolerance = 1e-9}};
    const auto home = deform(q, m, back);
    CHECK(home.report.energy == doctest::Approx(2).epsilon(1e-9));
    double off = 0;
    for (std::size_t v = 0; v < home.x.size(); ++v) off = std::max(off, glm::distance(home.x[v], m.points()[v]));
    CHECK(off < 1e-5);
}

TEST_CASE("deform: patch test, an affine map of the boundary is the affine map inside")
{
    const auto m = test::jittered_cube(test::sized(6, 4), 5);
    queue q(test::shared_context());
    const mat3 A(1.1, 0.1, 0.0, -0.2, 0.9, 0.1, 0.05, 0.1, 1.2);
    std::vector<idx> rim;
    for (const auto& f : taut::impl::boundary_facets(m)) rim.insert(rim.end(), f.begin(), f.end());
    std::sort(rim.begin(), rim.end());
    rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
    for (const precision how : {precision::fp64, precision::mixed})
    {
        deform_params<tetrahedron> params{
            .constraints = taut::constraints(m).move(rim, [&](const vec3& p) { return A * p + vec3(3); }),
            .precision = how,
            .solve = {.gradient_tolerance = 1e-12}};
        const auto r = deform(q, m, params);
        check_promises(m, params.constraints, r);
        double off = 0;
        for (std::size_t v = 0; v < r.x.size(); ++v)
            off = std::max(off, glm::distance(r.x[v], A * m.points()[v] + vec3(3)));
        CHECK(off < (how == precision::fp64 ? 1e-10 : 1e-5));
    }
}

TEST_CASE("deform: springs draw, single coordinates hold, vertices without cells stay, pieces apart are welcome")
{
    auto points = bar().points();
    auto cells = bar().cells();
    const auto n = static_cast<idx>(points.size());
    const auto other = test::single_tetrahedron();
    for (const vec3& p : other.points()) points.push_back(p + vec3(5, 0, 1));
    for (auto t : other.cells())
    {
        for (idx& v : t) v += n;
        cells.push_back(t);
    }
    points.emplace_back(-3, -3, -3);
    const mesh<tetrahedron> m(points, cells);
    queue q(test::shared_context());
    auto pins = taut::constraints(m).fix(bottom(m));
    for (const idx v : top(m)) pins.pin(v, 2, 3.3);
    pins.spring(n, {6, 1, 1}, 100.0);
    const auto r = deform(q, m, deform_params<tetrahedron>{.constraints = pins});
    check_promises(m, pins, r);
    CHECK(r.x.back() == vec3(-3, -3, -3));
    CHECK(glm::distance(r.x[static_cast<std::size_t>(n)], vec3(6, 1, 1)) < 1e-3);
    const double edge = glm::distance(r.x[static_cast<std::size_t>(n)], r.x[static_cast<std::size_t>(n) + 1]);
    CHECK(edge == doctest::Approx(1).epsilon(1e-5)); // the piece goes along
}

TEST_CASE("deform: what no shape can obey is refused with the elements")
{
    const auto m = bar();
    queue q(test::shared_context());
    // A tetrahedron whose four corners are pinned and mirrored.
    auto pins = taut::constraints(m);
    const auto& t = m.cells()[5];
    for (std::size_t k = 0; k < 4; ++k)
    {
        vec3 p = m.points()[static_cast<std::size_t>(t[k])];
        p.x = -p.x;
        pins.pin(t[k], p);
    }
    const auto r = deform(q, m, deform_params<tetrahedron>{.constraints = pins});
    CHECK(r.report.outcome == outcome::infeasible);
    CHECK(std::find(r.report.ids.begin(), r.report.ids.end(), 5) != r.report.ids.end());
    CHECK(r.report.seconds.follow == 0); // before it was tried

    // A session that was asked for it goes on as soon as it is asked for less.
    session s(q, m, {.constraints = pins});
    CHECK(!s.solve().report.reason.empty());
    for (std::size_t k = 1; k < 4; ++k) s.release(t[k]);
    check_promises(m, s.constraints(), s.solve());
}

TEST_CASE("deform: a mesh that is tangled is untangled first, and one whose rest is inverted is refused")
{
    const auto m = bar();
    queue q(test::shared_context());
    auto tangled = m.points();
    for (const idx v : where(m, [](const vec3& p) { return p.z == 1.5 || (p.z > 1 && p.z < 2 && p.x > 0.3); }))
        tangled[static_cast<std::size_t>(v)] = vec3(0.2, 0.2, 2.5);
    REQUIRE(certify<3>(m.cells(), tangled).flipped > 0);
    auto pins = taut::constraints(m).fix(bottom(m)).fix(top(m));
    const auto r = deform(q, m, deform_params<tetrahedron>{.constraints = pins, .initial = tangled});
    check_promises(m, pins, r);
    CHECK(r.report.energy == doctest::Approx(2).epsilon(1e-6));
    REQUIRE(!r.report.notes.empty());
    CHECK(r.report.notes[0].find("untangled") != std::string::npos);
    CHECK_THROWS_AS(deform(q, mesh<tetrahedron>(tangled, m.cells()), deform_params<tetrahedron>{}), mesh_error);
}

TEST_CASE("deform: limits leave the best shape so far, and wrong parameters are named")
{
    const auto m = bar();
    queue q(test::shared_context());
    const auto pins =
        taut::constraints(m).fix(bottom(m)).move(top(m), [](const vec3& p) { return p - vec3(0, 0, 1.8); });
    int asked = 0;
    deform_params<tetrahedron> params{.constraints = pins};
    const auto r = deform(q, m, params, {.observer = [&](const progress&) { return ++asked < 3; }});
    CHECK(r.report.outcome == outcome::stopped);
    CHECK(!r.report.pins_held);
    CHECK(r.report.distance > 0);
    CHECK(certify<3>(m.cells(), r.x));

    // Before the first step it is the shape to begin with.
    bool usable = false;
    run_limits limits{.observer = [&](const progress& p) { return usable = p.usable, false; }};
    const auto none = deform(q, m, params, limits);
    CHECK(usable);
    CHECK(none.report.outcome == outcome::stopped);
    CHECK(none.report.steps == 0);
    CHECK(none.report.distance > 0);
    CHECK(none.report.energy == doctest::Approx(2));
    CHECK(std::equal(none.x.begin(), none.x.end(), m.points().begin()));
    params.constraints = {};
    limits.time_limit = {};
    const auto late = deform(q, m, params, limits);
    CHECK(late.report.outcome == outcome::valid);
    CHECK(late.report.stopped);
    CHECK(late.report.pins_held);
    CHECK(!late.report.converged);

    CHECK_THROWS_WITH_AS(deform(q, m, deform_params<tetrahedron>{.initial = {vec3(0)}}), doctest::Contains("initial"),
                         parameter_error);
    CHECK_THROWS_AS(deform(q, m, deform_params<tetrahedron>{.solve = {.method = solve::method::lbfgs}}),
                    parameter_error);
    CHECK_THROWS_AS(
        deform(q, m, deform_params<tetrahedron>{.constraints = pins, .slides = {slide<3>::across(0, {0, 0, 1})}}),
        constraint_error);
}

TEST_CASE("deform: a mesh of the plane goes through the same door, a surface in space does not")
{
    const auto m = test::grid(test::sized(12, 6), test::sized(12, 6));
    queue q(test::shared_context());
    std::vector<idx> left, right;
    for (idx v = 0; v < m.vertex_count(); ++v)
    {
        const vec3& p = m.points()[static_cast<std::size_t>(v)];
        if (p.x == 0) left.push_back(v);
        if (p.x == 1) right.push_back(v);
    }
    const rigid_motion<2> quarter{.from = {1, 0.5}, .to = {1, 1.2}, .angle = 1.5};
    deform_params<triangle> params{.constraints = taut::constraints(m).fix(left).move(right, quarter)};
    const auto r = deform(q, m, params);
    check_promises(m, params.constraints, r);
    CHECK(r.report.converged);
    CHECK_THROWS_AS(deform(q, test::bumpy(5, 0.3, 1), deform_params<triangle>{}), parameter_error);
}

TEST_CASE("deform: a rotation of more than half a turn goes as far as it says, in the plane and in space")
{
    queue q(test::shared_context());
    constexpr int around = 24, rings = 17; // of fewer triangles would have to invert
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    std::vector<idx> inner, outer;
    for (int j = 0; j < rings; ++j)
        for (int i = 0; i < around; ++i)
        {
            const double a = 2 * std::numbers::pi * i / around;
            points.emplace_back((1 + j) * std::cos(a), (1 + j) * std::sin(a), 0);
            const idx v = j * around + i, next = j * around + (i + 1) % around;
            if (j == 0) inner.push_back(v);
            if (j + 1 == rings) outer.push_back(v);
            if (j + 1 == rings) continue;
            cells.push_back({v, v + around, next + around});
            cells.push_back({v, next + around, next});
        }
    const mesh<triangle> ring(points, cells);
    for (const double angle : {4.5, -4.5, 2 * std::numbers::pi})
    {
        CAPTURE(angle);
        const rigid_motion<2> by{.angle = angle};
        deform_params<triangle> params{.constraints = taut::constraints(ring).fix(outer).move(inner, by)};
        const auto r = deform(q, ring, params);
        check_promises(ring, params.constraints, r);
        // Once around: each vertex lags behind the next one inward by less than half a turn.
        const auto direction = [&](int j)
        {
            const vec2& p = r.x[static_cast<std::size_t>(j * around)];
            return std::atan2(p.y, p.x);
        };
        double wound = 0;
        for (int j = 1; j < rings; ++j) wound += std::remainder(direction(j - 1) - direction(j), 2 * std::numbers::pi);
        CHECK(wound == doctest::Approx(angle).epsilon(1e-6));
    }

    const auto m = tower(3, 3);
    auto params = deform_params<tetrahedron>{.constraints = taut::constraints(m).fix(bottom(m)).move(top(m), turn(4))};
    const auto far = deform(q, m, params);
    check_promises(m, params.constraints, far);
    params.constraints.rotations({}); // the same places, by the shorter way
    const auto near = deform(q, m, params);
    check_promises(m, params.constraints, near);
    CHECK(far.report.energy - 2 > 1.5 * (near.report.energy - 2)); // 2: of the shape at rest

    // Of a session, which goes on where its budget ended.
    session s(q, m, {.constraints = taut::constraints(m).fix(bottom(m))});
    REQUIRE(s.solve());
    s.move(top(m), turn(4));
    auto r = s.solve({.steps = 3});
    CHECK(!r.report.pins_held);
    for (int call = 0; call < 30 && !(r.report.pins_held && r.report.converged); ++call) r = s.solve({.steps = 20});
    check_promises(m, s.constraints(), r);
    CHECK(r.report.energy == doctest::Approx(far.report.energy).epsilon(1e-3));
    const auto steps = s.solve().report.steps;
    CHECK(steps == 0); // it does not go around again
}

TEST_CASE("deform: a planar mesh may lie at any height")
{
    auto points = test::grid(6, 6).points();
    for (vec3& p : points) p.z = -7.25;
    const mesh<triangle> m(points, test::grid(6, 6).cells());
    queue q(test::shared_context());
    std::vector<idx> left, right;
    for (idx v = 0; v < m.vertex_count(); ++v)
    {
        if (points[static_cast<std::size_t>(v)].x == 0) left.push_back(v);
        if (points[static_cast<std::size_t>(v)].x == 1) right.push_back(v);
    }
    const rigid_motion<2> by{.to = {0.3, 0.1}};
    deform_params<triangle> params{.constraints = taut::constraints(m).fix(left).move(right, by)};
    check_promises(m, params.constraints, deform(q, m, params));
    CHECK(smooth(q, m));
}

TEST_CASE("session: a volume follows a handle that is moved in many steps, injective at each")
{
    const auto m = bar();
    queue q(test::shared_context());
    session s(q, m, {.constraints = taut::constraints(m).fix(bottom(m))});
    REQUIRE(s.solve());
    const auto handle = top(m);
    const auto home = s.x();
    for (int frame = 1; frame <= 12; ++frame)
    {
        std::vector<vec3> places;
        for (const idx v : handle)
            places.push_back(turn(0.15 * frame, {0, 1, 0})(home[static_cast<std::size_t>(v)]) +
                             vec3(0.05 * frame, 0, 0));
        const auto before = s.x();
        const auto r = s.move(handle, places).solve({.steps = 2});
        CHECK(certify<3>(m.cells(), r.x));
        double jump = 0;
        for (std::size_t v = 0; v < before.size(); ++v) jump = std::max(jump, glm::distance(before[v], r.x[v]));
        CHECK(jump < 1);
    }
    const auto rest = s.solve();
    check_promises(m, s.constraints(), rest);
    CHECK(rest.report.converged);
    const auto scratch = deform(q, m, deform_params<tetrahedron>{.constraints = s.constraints()});
    CHECK(rest.report.energy == doctest::Approx(scratch.report.energy).epsilon(1e-3));
}
