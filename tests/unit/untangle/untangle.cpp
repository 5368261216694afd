// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <support/meshes.hpp>
#include <support/stage_watch.hpp>
#include <support/untangle_checks.hpp>
#include <support/winding.hpp>

#include <taut/impl/core/start/barycentric_map.hpp>
#include <taut/impl/core/untangle/untangle_host.hpp>
#include <taut/untangle.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using test::check_typed;

/// The plane mesh with its boundary pinned at place(p) and its other vertices there too.
template <class Place>
untangle_problem<triangle> pinned_boundary(mesh<triangle> m, Place place)
{
    std::vector<vec2> x;
    for (const vec3& p : m.points()) x.push_back(place(vec2(p.x, p.y)));
    fixed_marks<2> held(x.size());
    for (const auto& e : boundary_facets(m))
        for (const taut::idx v : e) held[static_cast<std::size_t>(v)] = 3;
    return {std::move(m), std::move(x), std::move(held)};
}

untangle_problem<triangle> square(int n)
{
    return pinned_boundary(test::grid(n, n), [](vec2 p) { return p; });
}

void scramble(untangle_problem<triangle>& problem, unsigned seed, double size)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> at(-size, size);
    for (std::size_t v = 0; v < problem.initial.size(); ++v)
        if (!problem.held[v]) problem.initial[v] += vec2(at(random), at(random));
}

} // namespace

TEST_CASE("untangle: a scrambled square is unfolded with its boundary where it was")
{
    auto problem = square(10);
    scramble(problem, 3, 1.0);
    const auto result = untangle(problem);
    check_typed(problem, result);
    CHECK(result.outcome == outcome::valid);
    CHECK(result.least_relative_det > 0.1);
    CHECK_FALSE(result.stage.empty());
}

TEST_CASE("untangle: a map without folds comes back as it is")
{
    const auto problem = square(4);
    const auto result = untangle(problem);
    CHECK(result.stage == "initial");
    CHECK(result.stages.empty());
    CHECK(std::memcmp(result.map.data(), problem.initial.data(), problem.initial.size() * sizeof(vec2)) == 0);
}

TEST_CASE("untangle: the stages that ran are reported from the proofs to the margin, and take the time of the run")
{
    auto problem = square(16);
    std::swap(problem.initial[100], problem.initial[180]);
    test::stage_watch watch;
    const auto result = untangle(problem, {}, {.observer = watch.observer()});
    watch.check_complete(result.stages);
    REQUIRE(result);
    REQUIRE(result.stages.size() >= 3);
    CHECK(result.stages.front().stage == "proofs");
    CHECK(result.stages.back().stage == "margin");
    CHECK(result.stages.back().energy_after <= result.stages.back().energy_before);
    double sum = 0;
    for (const auto& s : result.stages)
    {
        sum += s.seconds;
        CHECK(s.vertices == problem.initial.size());
        CHECK((s.stop == "injective") == (s.stage == result.stage));
    }
    CHECK(sum <= result.seconds);
}

TEST_CASE("untangle: pins inside are reached past each other")
{
    auto problem = square(16);
    // A ring of pins, turned by 100 degrees about the centre.
    const double c = std::cos(1.75), s = std::sin(1.75);
    for (std::size_t v = 0; v < problem.held.size(); ++v)
    {
        const vec2 p = problem.initial[v] - vec2(0.5, 0.5);
        if (std::abs(glm::length(p) - 0.2) > 0.02) continue;
        problem.held[v] = 3;
        problem.initial[v] = vec2(0.5, 0.5) + vec2(c * p.x - s * p.y, s * p.x + c * p.y);
    }
    REQUIRE(!certify<2>(problem.rest.cells(), std::span<const vec2>(problem.initial)));
    const auto result = untangle(problem);
    check_typed(problem, result);
    CHECK(result.outcome == outcome::valid);
}

TEST_CASE("untangle: a boundary that is not convex is filled")
{
    // A band bent to three quarters of a ring: the harmonic map of it has folds.
    auto problem = pinned_boundary(test::grid(24, 4),
                                   [](vec2 p)
                                   {
                                       const double a = 4.7 * p.x, r = 1 - 0.5 * p.y;
                                       return vec2(r * std::sin(a), -r * std::cos(a));
                                   });
    for (std::size_t v = 0; v < problem.held.size(); ++v)
        if (!problem.held[v]) problem.initial[v] = vec2(0.0);
    const auto result = untangle(problem);
    check_typed(problem, result);
    CHECK(result.outcome == outcome::valid);
}

TEST_CASE("untangle: coordinates are held one by one")
{
    auto problem = square(6);
    for (std::size_t v = 0; v < problem.held.size(); ++v)
    {
        const vec2 p = problem.initial[v];
        if (!problem.held[v]) continue;
        problem.held[v] = (p.x == 0 || p.x == 1 ? 1 : 0) | (p.y == 0 || p.y == 1 ? 2 : 0); // slides along its side
    }
    scramble(problem, 5, 0.6);
    problem.initial[1].x = -0.0;
    const auto result = untangle(problem);
    check_typed(problem, result);
    CHECK(result.outcome == outcome::valid);
}

TEST_CASE("untangle: a few pins, or none, are enough where everything else is free")
{
    for (const int pins : {0, 1, 2})
    {
        CAPTURE(pins);
        auto problem = square(5);
        problem.held = fixed_marks<2>(problem.held.size());
        scramble(problem, 7, 1.0);
        if (pins > 0) problem.held[0] = 3;
        if (pins > 1) problem.held[35] = 3;
        const auto result = untangle(problem);
        check_typed(problem, result);
        CHECK(result.outcome == outcome::valid);
    }
}

TEST_CASE("untangle: what cannot be is refused with a proof")
{
    auto mirrored = square(4);
    for (vec2& p : mirrored.initial) p.x = -p.x;
    const auto result = untangle(mirrored);
    check_typed(mirrored, result);
    CHECK(result.outcome == outcome::infeasible);
}

TEST_CASE("untangle: a limit, a cancel and a lack of stages end with the best map and a reason")
{
    auto problem = square(8);
    problem.held[40] = 3;
    problem.initial[40] = vec2(0.9, 0.9);
    scramble(problem, 11, 1.0);

    const auto late = untangle(problem, {}, {.time_limit = std::chrono::duration<double>(0)});
    check_typed(problem, late);
    CHECK(late.outcome == outcome::gave_up);
    CHECK(late.reason.find("time limit") != std::string::npos);

    const auto cancelled = untangle(problem, {}, {.observer = [](const taut::progress&) { return false; }});
    check_typed(problem, cancelled);
    CHECK(cancelled.reason.find("cancelled") != std::string::npos);

    // The question comes within the first step, too, which is then not made.
    int asked = 0;
    untangle_params params{.stages = {"newton"}};
    const auto within = untangle(problem, params, {.observer = [&](const taut::progress&) { return ++asked < 3; }});
    check_typed(problem, within);
    CHECK(asked == 3);
    REQUIRE(within.stages.size() == 2);
    CHECK(within.stages[0].stage == "proofs");
    CHECK(within.stages[1].stage == "newton");
    CHECK(within.stages[1].stop == "user");
    CHECK(within.stages[1].iterations <= 1);

    params = {};
    params.stages = {"harmonic"};
    const auto alone = untangle(problem, params);
    check_typed(problem, alone);
    CHECK(alone.outcome == outcome::gave_up);
    CHECK(alone.flips.flipped <= certify<2>(problem.rest.cells(), std::span<const vec2>(problem.initial)).flipped);
}

TEST_CASE("untangle: each stage can run alone")
{
    auto problem = square(8);
    problem.held[40] = 3;
    problem.initial[40] = vec2(0.7, 0.6);
    scramble(problem, 13, 0.15);
    for (const char* stage : {"newton", "pull", "stretch"})
    {
        CAPTURE(stage);
        untangle_params params;
        params.stages = {stage};
        const auto result = untangle(problem, params);
        check_typed(problem, result);
        CHECK(result.outcome == outcome::valid);
    }
}

TEST_CASE("untangle: bad parameters are named")
{
    const auto problem = square(2);
    untangle_params params;
    params.stages = {"newton", "nonesuch"};
    CHECK_THROWS_WITH_AS(untangle(problem, params), doctest::Contains("nonesuch"), parameter_error);
    params = {};
    params.rounds = 0;
    CHECK_THROWS_WITH_AS(untangle(problem, params), doctest::Contains("rounds"), parameter_error);
}

TEST_CASE("untangle: the scale of the map does not matter")
{
    for (const double scale : {1e-150, 1.0, 1e150})
    {
        CAPTURE(scale);
        auto problem = square(6);
        scramble(problem, 17, 0.5);
        for (vec2& p : problem.initial) p *= scale;
        const auto result = untangle(problem);
        check_typed(problem, result);
        CHECK(result.outcome == outcome::valid);
    }
}

TEST_CASE("untangle: random pins on a free boundary give maps that wind once around every vertex")
{
    std::mt19937 random(3);
    const auto uniform = [&](double from, double to)
    { return from + (to - from) * (static_cast<double>(random()) / random.max()); };
    int solved = 0;
    constexpr int cases = 30;
    for (int k = 0; k < cases; ++k)
    {
        CAPTURE(k);
        const auto m = test::bumpy(10, 0.4, static_cast<std::uint32_t>(k));
        const auto free = barycentric_map(m);
        untangle_problem<triangle> problem{m, free.uv, fixed_marks<2>(free.uv.size())};
        if (k % 2 == 0) problem.draft = free.uv;
        const int pins = 1 + static_cast<int>(uniform(0, 6));
        const double most = uniform(0.05, 0.5);
        for (int i = 0; i < pins; ++i)
        {
            const std::size_t v = random() % free.uv.size();
            if (problem.held[v] != 0) continue;
            problem.held[v] = problem.held.every;
            problem.initial[v] += vec2(uniform(-most, most), uniform(-most, most));
        }
        untangle_params params;
        params.rounds = 2;
        const auto r = untangle(problem, params);
        test::check_typed(problem, r);
        if (!r) continue;
        ++solved;
        CHECK(test::wound_vertices(m, r.map).empty());
    }
    CHECK(solved >= 28);
}

TEST_CASE("untangle: a map that winds twice is not injective, and gets another one")
{
    const int n = 12;
    const auto m = test::fan(n, true);
    untangle_problem<triangle> problem{m, {vec2(0.0)}, fixed_marks<2>(n + 1)};
    for (int k = 0; k < n; ++k)
    {
        const double angle = 4 * std::numbers::pi * k / n;
        problem.initial.emplace_back(std::cos(angle), std::sin(angle));
    }
    problem.held[0] = problem.held[1] = problem.held.every;
    const auto freed = untangle(problem);
    CHECK(static_cast<bool>(freed));
    CHECK(freed.stage != "initial");
    test::check_typed(problem, freed);

    // Held where it is, it can only be refused.
    for (std::size_t v = 0; v < problem.held.size(); ++v) problem.held[v] = problem.held.every;
    const auto held = untangle(problem);
    CHECK(held.outcome == outcome::infeasible);
    CHECK(held.ids == std::vector<taut::idx>{0});
    CHECK(held.flips.branched == 1);

    // With one vertex free there is no proof, and no other map.
    problem.held[5] = 0;
    untangle_params params;
    params.rounds = 1;
    const auto tried = untangle(problem, params);
    CHECK(tried.outcome == outcome::gave_up);
    CHECK(tried.ids == std::vector<taut::idx>{0});
    CHECK(tried.reason.find("1 vertex (0) that the map winds around more than once") != std::string::npos);
}

TEST_CASE("untangle: the shapes that are wanted stand for a rest shape that is none")
{
    // The inner vertex of four tetrahedra lies outside, at rest, too.
    const std::vector<vec3> points = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {3, 3, 3}};
    const mesh<tetrahedron> m(points, {{4, 1, 2, 3}, {0, 4, 2, 3}, {0, 1, 4, 3}, {0, 1, 2, 4}});
    untangle_problem<tetrahedron> problem{m, points, fixed_marks<3>(5)};
    for (std::size_t v = 0; v < 4; ++v) problem.held[v] = problem.held.every;
    problem.wanted.assign(4, regular_ideal<tetrahedron>());
    const auto r = untangle(problem);
    CHECK(static_cast<bool>(r));
    CHECK(r.least_relative_det > 0);

    problem.wanted.pop_back();
    CHECK_THROWS_WITH_AS(untangle(problem), doctest::Contains("wanted"), parameter_error);
    problem.wanted.clear();
    problem.owners = {0, 0, 1};
    CHECK_THROWS_WITH_AS(untangle(problem), doctest::Contains("owners"), parameter_error);
}
