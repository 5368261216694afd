// SPDX-License-Identifier: MIT
#include <span>

#include <doctest/doctest.h>

#include <support/infeasible_problems.hpp>
#include <support/meshes.hpp>
#include <support/untangle_checks.hpp>
#include <taut/map/deform_refined.hpp>
#include <taut/untangle/untangle_refined.hpp>

using namespace taut;

namespace
{

template <class Element>
void check_mended(const untangle_problem<Element>& problem)
{
    queue q;
    REQUIRE(untangle(q, problem).outcome == untangle_outcome::infeasible);
    const auto [result, refined] = untangle_refined(q, problem);
    REQUIRE(result);
    test::check_typed(refined.problem, result);
    CHECK(!refined.how.empty());
    for (std::size_t v = 0; v < problem.initial.size(); ++v)
        if (problem.held.all(v)) CHECK(result.map[v] == problem.initial[v]);
}

} // namespace

TEST_CASE("untangle_refined: what has no solution on its mesh has one where elements are split")
{
    check_mended(test::folded_edge());
    check_mended(test::reflex_quad());
    check_mended(test::fan_in_a_u());
}

TEST_CASE("untangle_refined: where no map is found, and nothing is proved, what is left inverted is split")
{
    const auto problem = test::cone_in_a_u();
    REQUIRE(!find_infeasibility(problem));
    queue q;
    const auto [result, refined] = untangle_refined(q, problem, {.rounds = 1}, {.rounds = 2, .most_growth = 3});
    test::check_typed(refined.problem, result);
    CHECK(refined.rounds > 0);
    CHECK(refined.cells.size() <= 3 * problem.rest.cells().size());
    for (std::size_t v = 0; v < problem.initial.size(); ++v)
        if (problem.held.all(v)) CHECK(result.map[v] == problem.initial[v]);
}

TEST_CASE("untangle_refined: a mesh that has a solution is not split")
{
    auto problem = test::reflex_quad();
    problem.initial[0] = vec2(0, 0);
    queue q;
    const auto r = untangle_refined(q, problem);
    CHECK(r.result);
    CHECK(r.refined.how.empty());
    CHECK(r.refined.cells == std::vector<taut::idx>{0, 1});
}

TEST_CASE("untangle_refined: what splits do not mend is infeasible, with the reason")
{
    auto problem = test::folded_edge();
    for (auto& x : problem.initial) x.x = -x.x;
    queue q;
    const auto r = untangle_refined(q, problem).result;
    CHECK(r.outcome == untangle_outcome::infeasible);
    CHECK(r.reason.find("no split inside") != std::string::npos);
}

TEST_CASE("untangle_refined: who says no is not asked again")
{
    const auto problem = test::fan_in_a_u();
    queue q;
    untangle_params params;
    int asked = 0;
    params.observer = [&](const progress&) { return ++asked < 0; };
    const auto r = untangle_refined(q, problem, params).result;
    CHECK(!r);
    CHECK(asked == 1);
}

TEST_CASE("deform_refined: pins that turn an element over are met on a refined mesh")
{
    const auto problem = test::folded_edge();
    queue q;
    deform_params<tetrahedron> params;
    params.constraints = constraints(problem.rest);
    for (taut::idx v = 0; v < problem.rest.vertex_count(); ++v)
        params.constraints.pin(v, problem.initial[static_cast<std::size_t>(v)]);
    CHECK(deform(q, problem.rest, params).report.outcome == outcome::infeasible);
    const auto found = deform_refined(q, problem.rest, params);
    REQUIRE(found.result);
    CHECK(found.result.report.pins_held);
    CHECK(found.how.middles().size() == 1);
    CHECK(certify<3>(found.refined.cells(), std::span<const vec3>(found.result.x)));
    for (std::size_t v = 0; v < problem.initial.size(); ++v) CHECK(found.result.x[v] == problem.initial[v]);

    params.targets.assign(problem.rest.cells().size(), mat3(1.0));
    CHECK_THROWS_AS(deform_refined(q, problem.rest, params), parameter_error);
}
