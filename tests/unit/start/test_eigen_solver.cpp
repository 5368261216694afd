// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <support/meshes.hpp>

#include <taut/map/barycentric_map.hpp>
#include <taut/map/eigen_solver.hpp>

using taut::barycentric_weights;

TEST_CASE("eigen solver: agrees with the elimination")
{
    const auto m = taut::test::bumpy(20, 0.4, 9);
    for (const auto weights : {barycentric_weights::uniform, barycentric_weights::mean_value})
    {
        const auto own = taut::barycentric_map(m, {.weights = weights});
        const auto eigen = taut::barycentric_map(m, {.weights = weights}, taut::eigen_solver{});
        CHECK(eigen.flips.flipped == 0);
        double difference = 0;
        for (std::size_t v = 0; v < own.uv.size(); ++v)
            difference = std::max(difference, glm::distance(own.uv[v], eigen.uv[v]));
        CHECK(difference < 1e-13);
    }
    CHECK(taut::eigen_solver{}(taut::barycentric_system{}).empty());
}
