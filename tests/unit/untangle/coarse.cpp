// SPDX-License-Identifier: MIT
#include <cmath>
#include <random>
#include <vector>

#include <doctest/doctest.h>
#include <support/meshes.hpp>
#include <support/untangle_checks.hpp>
#include <support/winding.hpp>

#include <taut/impl/core/untangle/untangle_host.hpp>
#include <taut/untangle.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using test::check_typed;

/// A square that has coarser levels, its vertices inside scrambled; the boundary is pinned if `bound`.
untangle_problem<triangle> scrambled(bool bound)
{
    mesh<triangle> m = test::grid(48, 48);
    std::vector<vec2> x(m.points().begin(), m.points().end());
    fixed_marks<2> held(x.size());
    std::vector<char> outer(x.size(), 0);
    for (const auto& e : boundary_facets(m))
        for (const taut::idx v : e) outer[static_cast<std::size_t>(v)] = 1;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> at(-0.3, 0.3);
    for (std::size_t v = 0; v < x.size(); ++v)
        if (!outer[v])
            x[v] += vec2(at(random), at(random));
        else if (bound)
            held[v] = 3;
    return {std::move(m), std::move(x), std::move(held)};
}

/// Pins the vertex with these numbers along the sides of the grid to its place at rest, turned about the centre.
void pin_turned(untangle_problem<triangle>& p, int i, int j, double angle)
{
    const auto v = static_cast<std::size_t>(j * 49 + i);
    const vec3 at = p.rest.points()[v], centre = p.rest.points()[24 * 49 + 24];
    const double c = std::cos(angle), s = std::sin(angle);
    const vec2 d(at.x - centre.x, at.y - centre.y);
    p.initial[v] = vec2(centre.x, centre.y) + vec2(c * d.x - s * d.y, s * d.x + c * d.y);
    p.held[v] = 3;
}

bool coarse_alone(const untangle_result<triangle>& r)
{
    bool coarser = false;
    for (const auto& s : r.stages)
    {
        if (s.level == 0 && s.stage == "newton") return false;
        coarser = coarser || s.level > 0;
    }
    return coarser && r.stage == "coarse";
}

} // namespace

TEST_CASE("coarse untangling: a coarse level is untangled, and its map carried up with pins bit for bit")
{
    auto problem = scrambled(true);
    for (const int i : {14, 24, 34})
        for (const int j : {14, 34}) pin_turned(problem, i, j, 0.5);
    const auto r = untangle(problem);
    check_typed(problem, r);
    REQUIRE(r);
    CHECK(coarse_alone(r));
    CHECK(r.least_relative_det > 0.01);
    std::size_t level = std::size_t(-1);
    for (const auto& s : r.stages)
        if (s.stage == "reinsert")
        {
            CHECK(s.level < level);
            CHECK(s.energy_after <= s.energy_before);
            level = s.level;
        }
    CHECK(level == 0);
}

TEST_CASE("coarse untangling: a free boundary and single coordinates, without branch points")
{
    auto problem = scrambled(false);
    pin_turned(problem, 10, 10, 0.3);
    pin_turned(problem, 38, 38, 0.3);
    pin_turned(problem, 38, 10, 0.3);
    problem.held[24 * 49 + 24] = 1;
    const auto r = untangle(problem);
    check_typed(problem, r);
    REQUIRE(r);
    CHECK(coarse_alone(r));
    CHECK(test::wound_vertices(problem.rest, r.map).empty());
}

TEST_CASE("coarse untangling: pins so dense that no coarse level has room for them are reached on the mesh itself")
{
    auto problem = scrambled(true);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> at(-0.4, 0.4);
    const double edge = problem.rest.points()[1].x - problem.rest.points()[0].x;
    for (int j = 16; j < 32; j += 2)
        for (int i = 16; i < 32; i += 2)
        {
            pin_turned(problem, i, j, 0);
            problem.initial[static_cast<std::size_t>(j * 49 + i)] += edge * vec2(at(random), at(random));
        }
    const auto r = untangle(problem);
    check_typed(problem, r);
    CHECK(r);
}

TEST_CASE("coarse untangling: what is infeasible is proved on the mesh itself, and a refusal ends it")
{
    auto problem = scrambled(true);
    int asked = 0;
    const auto stopped = untangle(problem, {}, {.observer = [&](const progress&) { return ++asked < 3; }});
    check_typed(problem, stopped);
    CHECK(stopped.outcome == outcome::gave_up);

    problem.initial[0].x += 40; // a corner of the boundary beyond the others
    const auto infeasible = untangle(problem);
    check_typed(problem, infeasible);
    CHECK(infeasible.outcome == outcome::infeasible);
    for (const auto& s : infeasible.stages) CHECK(s.level == 0);
}
