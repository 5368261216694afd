// SPDX-License-Identifier: MIT
#include <algorithm>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include <support/infeasible_problems.hpp>
#include <support/meshes.hpp>
#include <taut/impl/core/untangle/untangle_refined.hpp>
#include <taut/untangle.hpp>

using namespace taut;
using namespace taut::impl;

TEST_CASE("refine_infeasible: an element that its pinned corners turn over is split at its edge inside")
{
    const auto check = [](const auto& problem)
    {
        REQUIRE(find_infeasibility(problem));
        const auto r = refine_infeasible(problem);
        CHECK(r.obstacle.empty());
        CHECK(r.rounds == 1);
        CHECK(r.how.middles().size() == 1);
        CHECK(!find_infeasibility(r.problem));
        const std::size_t n = problem.initial.size();
        REQUIRE(r.problem.initial.size() == n + 1);
        CHECK(!r.problem.held.any(n)); // what is new is free
        CHECK(r.problem.held.count() == problem.held.count());
        for (std::size_t v = 0; v < n; ++v) CHECK(r.problem.initial[v] == problem.initial[v]);
        CHECK(r.cells.size() == r.problem.rest.cells().size());
    };
    check(test::folded_edge());
    check(test::reflex_quad());
}

TEST_CASE("refine_infeasible: a vertex without a place gets edges that bend")
{
    const auto problem = test::fan_in_a_u();
    const auto proof = find_infeasibility(problem);
    REQUIRE(proof.proofs[0].kind == proof.empty_star);
    const auto r = refine_infeasible(problem);
    CHECK(r.obstacle.empty());
    CHECK(r.rounds == 1);
}

TEST_CASE("refine_infeasible: a problem without a proof is left as it is")
{
    auto problem = test::reflex_quad();
    problem.initial[0] = vec2(0, 0);
    const auto r = refine_infeasible(problem);
    CHECK(r.how.empty());
    CHECK(r.rounds == 0);
    CHECK(r.problem.rest.cells() == problem.rest.cells());
}

TEST_CASE("refine_infeasible: what a pinned boundary proves by itself is an obstacle that is named")
{
    auto problem = test::folded_edge();
    for (auto& x : problem.initial) x.x = -x.x;
    const auto mirrored = refine_infeasible(problem);
    CHECK(mirrored.obstacle.find("encloses") != std::string::npos);
    CHECK(mirrored.obstacle.find("no split inside") != std::string::npos);

    const auto some = test::folded_edge();
    CHECK(refine_infeasible(some, {.rounds = 0}).obstacle.find("0 rounds") != std::string::npos);
    CHECK(refine_infeasible(some, {.max_growth = 1.5}).obstacle.find("1.5 times") != std::string::npos);
    CHECK_THROWS_AS(refine_infeasible(some, {.rounds = -1}), parameter_error);
    CHECK_THROWS_AS(refine_infeasible(some, {.max_growth = 0.5}), parameter_error);

    auto corners = some;
    corners.owners.assign(corners.rest.cells().size(), 0);
    CHECK_THROWS_AS(refine_infeasible(corners), parameter_error);
}

TEST_CASE("refine_problem: parts are wanted to look like the whole, and count as much together")
{
    auto problem = test::folded_edge();
    problem.wanted.assign(problem.rest.cells().size(), mat3(2.0));
    const auto r = refine_infeasible(problem);
    double sum = 0;
    for (const auto& W : r.problem.wanted) sum += glm::determinant(W);
    CHECK(sum == doctest::Approx(8.0 * static_cast<double>(problem.wanted.size())));
}

TEST_CASE("splits_around: edges inside between held vertices near by, else the longest of each element in the map")
{
    const auto chord = test::folded_edge();
    const std::vector<taut::idx> first{0};
    CHECK(splits_around(chord, first).simplices == std::vector<std::vector<taut::idx>>{{0, 1}});
    auto free = test::cone_in_a_u();
    free.held = fixed_marks<3>(free.initial.size());
    free.held[0] = free.held.every;
    const auto splits = splits_around(free, first).simplices;
    REQUIRE(splits.size() == 1);
    double longest = 0;
    const auto distance = [&](taut::idx a, taut::idx b)
    { return glm::distance(free.initial[std::size_t(a)], free.initial[std::size_t(b)]); };
    for (const taut::idx v : free.rest.cells()[0]) longest = std::max(longest, distance(v, 16)); // 16: inside
    CHECK(splits[0][1] == 16);
    CHECK(distance(splits[0][0], 16) == longest);
}
