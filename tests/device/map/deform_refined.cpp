// SPDX-License-Identifier: MIT
#include <span>

#include <doctest/doctest.h>

#include <support/infeasible_problems.hpp>
#include <support/shared_context.hpp>
#include <taut/deform.hpp>

using namespace taut;

TEST_CASE("deform with refinement: pins that turn an element over are met on a refined mesh")
{
    const auto problem = test::folded_edge();
    queue q(test::shared_context());
    deform_params<tetrahedron> params;
    params.constraints = constraints(problem.rest);
    for (taut::idx v = 0; v < problem.rest.vertex_count(); ++v)
        params.constraints.pin(v, problem.initial[static_cast<std::size_t>(v)]);
    CHECK(deform(q, problem.rest, params).report.outcome == outcome::infeasible);
    const auto found = deform(q, problem.rest, params, {}, {});
    REQUIRE(found.result);
    CHECK(found.result.report.pins_held);
    CHECK(found.how.middles().size() == 1);
    CHECK(certify<3>(found.refined.cells(), std::span<const vec3>(found.result.x)));
    for (std::size_t v = 0; v < problem.initial.size(); ++v) CHECK(found.result.x[v] == problem.initial[v]);

    params.targets.assign(problem.rest.cells().size(), mat3(1.0));
    CHECK_THROWS_AS(deform(q, problem.rest, params, {}, {}), parameter_error);
}
