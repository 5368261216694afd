// SPDX-License-Identifier: MIT
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>

#include <taut/impl/core/objective/volume_objective.hpp>
#include <taut/impl/core/untangle/untangle_host.hpp>
#include <taut/untangle.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

/// A bar of which one end is held and the other one is turned by half a turn: half of what is in between is inverted.
untangle_problem<tetrahedron> twisted_ends()
{
    const auto cube = test::jittered_cube(test::sized(5, 3), 2);
    auto points = cube.points();
    for (vec3& p : points) p.z *= 3;
    fixed_marks<3> held(points.size());
    auto x = points;
    for (std::size_t v = 0; v < x.size(); ++v)
    {
        if (points[v].z != 0 && points[v].z != 3) continue;
        held[v] = held.every;
        if (points[v].z == 3) x[v] = vec3(1 - points[v].x, 1 - points[v].y, 3.2);
    }
    return {mesh<tetrahedron>(std::move(points), cube.cells()), std::move(x), std::move(held)};
}

} // namespace

TEST_CASE("lead: handles of a volume go to their places from the shape at rest, bit for bit, nothing inverted")
{
    const auto problem = twisted_ends();
    REQUIRE(certify<3>(problem.rest.cells(), std::span<const vec3>(problem.initial)).flipped > 0);
    queue q(test::shared_context());
    const auto r = untangle(q, problem, {.stages = {"lead"}});
    REQUIRE(r);
    CHECK(r.stage == "lead");
    CHECK(certify<3>(problem.rest.cells(), std::span<const vec3>(r.map)));
    for (std::size_t v = 0; v < r.map.size(); ++v)
        if (problem.held.any(v)) CHECK(std::memcmp(&r.map[v], &problem.initial[v], sizeof(vec3)) == 0);
    CHECK(untangle(q, problem)); // with all stages
}

TEST_CASE("lead: without a positive shape at rest, or time, it gives up")
{
    auto problem = twisted_ends();
    queue q(test::shared_context());
    const run_limits limits{.observer = [](const progress&) { return false; }};
    CHECK(untangle(q, problem, {.stages = {"lead"}}, limits).outcome == outcome::gave_up);

    auto points = problem.rest.points();
    for (vec3& p : points) p.x = -p.x;
    problem.rest = mesh<tetrahedron>(std::move(points), problem.rest.cells());
    CHECK(untangle(q, problem, {.stages = {"lead"}}).outcome == outcome::gave_up);
}
