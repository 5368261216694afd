// SPDX-License-Identifier: MIT
#include <vector>

#include <doctest/doctest.h>

#include <support/rbf_points.hpp>
#include <support/shared_context.hpp>
#include <taut/impl/charts/paste/rbf.hpp>
#include <taut/impl/charts/paste/rbf_evaluator.hpp>

using namespace taut;
using namespace taut::impl;

TEST_CASE("rbf evaluator: the device has the field of the host, one launch a field")
{
    queue q(test::shared_context());
    for (const auto basis : test::all_bases)
    {
        CAPTURE(static_cast<int>(basis));
        const auto centres = test::scattered_points(70, 1, 3.0), points = test::scattered_points(301, 2, 4.0);
        const rbf solver(centres, {.basis = basis, .radius = 2});
        const auto first = solver.solve(test::scattered_points(70, 3)),
                   second = solver.solve(test::scattered_points(70, 4));
        rbf_evaluator evaluate(q, first, points);
        for (const auto* field : {&first, &second})
        {
            const auto before = q.counters().launches;
            const auto values = evaluate(*field);
            CHECK(q.counters().launches == before + 1);
            REQUIRE(values.size() == points.size());
            double scale = 0;
            for (const vec3& w : field->weights) scale += glm::length(w);
            const double tolerance = (q.device().has_fp64() ? 1e-14 : 1e-6) * (1 + scale);
            for (std::size_t i = 0; i < points.size(); ++i)
                CHECK(glm::distance(values[i], (*field)(points[i])) < tolerance);
        }
    }
    rbf_evaluator none;
    CHECK(none(rbf_field{}).empty());
    const auto field = rbf(test::scattered_points(5, 1)).solve(test::scattered_points(5, 2));
    rbf_evaluator other(q, field, test::scattered_points(3, 3));
    CHECK_THROWS_AS(other(rbf_field{}), parameter_error);
}
