// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <support/infeasible_problems.hpp>
#include <support/shared_context.hpp>
#include <support/untangle_checks.hpp>
#include <taut/impl/core/untangle/untangle_host.hpp>
#include <taut/untangle.hpp>

using namespace taut;

namespace
{

template <class Element>
void check_mended(const untangle_problem<Element>& problem)
{
    queue q(test::shared_context());
    REQUIRE(untangle(q, problem).outcome == outcome::infeasible);
    const auto [result, refined] = untangle(q, problem, {}, {}, {});
    REQUIRE(result);
    test::check_typed(refined.problem, result);
    CHECK(!refined.how.empty());
    for (std::size_t v = 0; v < problem.initial.size(); ++v)
        if (problem.held.all(v)) CHECK(result.map[v] == problem.initial[v]);
}

} // namespace

TEST_CASE("untangle with refinement: what has no solution on its mesh has one where elements are split")
{
    check_mended(test::folded_edge());
    check_mended(test::reflex_quad());
    check_mended(test::fan_in_a_u());
}

TEST_CASE("untangle with refinement: what is proved of a star in space stays within the bounds")
{
    const auto problem = test::cone_in_a_u();
    REQUIRE(find_infeasibility(problem));
    queue q(test::shared_context());
    const auto [result, refined] = untangle(q, problem, {.rounds = 1}, {}, {.rounds = 2, .max_growth = 3});
    test::check_typed(refined.problem, result);
    CHECK(refined.cells.size() <= 3 * problem.rest.cells().size());
    for (std::size_t v = 0; v < problem.initial.size(); ++v)
        if (problem.held.all(v)) CHECK(result.map[v] == problem.initial[v]);
}

TEST_CASE("untangle with refinement: a mesh that has a solution is not split")
{
    auto problem = test::reflex_quad();
    problem.initial[0] = vec2(0, 0);
    queue q(test::shared_context());
    const auto r = untangle(q, problem, {}, {}, {});
    CHECK(r.result);
    CHECK(r.refined.how.empty());
    CHECK(r.refined.cells == std::vector<taut::idx>{0, 1});
}

TEST_CASE("untangle with refinement: what splits do not mend is infeasible, with the reason")
{
    auto problem = test::folded_edge();
    for (auto& x : problem.initial) x.x = -x.x;
    queue q(test::shared_context());
    const auto r = untangle(q, problem, {}, {}, {}).result;
    CHECK(r.outcome == outcome::infeasible);
    CHECK(r.reason.find("no split inside") != std::string::npos);
}

TEST_CASE("untangle with refinement: who says no is not asked again")
{
    const auto problem = test::fan_in_a_u();
    queue q(test::shared_context());
    int asked = 0;
    const run_limits limits{.observer = [&](const progress&) { return ++asked < 0; }};
    const auto r = untangle(q, problem, {}, limits, {}).result;
    CHECK(!r);
    CHECK(asked == 1);
}
