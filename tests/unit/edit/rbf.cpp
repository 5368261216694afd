// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include <support/rbf_points.hpp>
#include <taut/impl/charts/paste/rbf.hpp>

using namespace taut;

TEST_CASE("rbf: every basis interpolates at its points")
{
    for (const auto basis : test::all_bases)
        for (const double size : {1e-3, 1.0, 1e4})
        {
            CAPTURE(static_cast<int>(basis));
            const auto points = test::scattered_points(200, 1, size), values = test::scattered_points(200, 2, size);
            const taut::impl::rbf solver(points, {.basis = basis});
            CHECK(solver.reciprocal_condition() > 1e-16);
            const auto field = solver.solve(values);
            for (std::size_t i = 0; i < points.size(); ++i)
                CHECK(glm::distance(field(points[i]), values[i]) < 1e-9 * size);
        }
}

TEST_CASE("rbf: polynomials of the degree that comes with a basis are reproduced")
{
    const auto points = test::scattered_points(60, 3), others = test::scattered_points(20, 4);
    const auto affine = [](const vec3& p) { return vec3(1 + p.x, 2 * p.y - p.z, 0.5 - 3 * p.x + p.z); };
    for (const auto basis : {taut::impl::rbf_basis::cubic, taut::impl::rbf_basis::thin_plate})
    {
        std::vector<vec3> values;
        for (const vec3& p : points) values.push_back(affine(p));
        const auto field = taut::impl::rbf(points, {.basis = basis}).solve(values);
        for (const vec3& p : others) CHECK(glm::distance(field(p), affine(p)) < 1e-9);
    }
    const auto constant =
        taut::impl::rbf(points, {.basis = taut::impl::rbf_basis::linear}).solve(std::vector<vec3>(60, vec3(1, 2, 3)));
    for (const vec3& p : others) CHECK(glm::distance(constant(p), vec3(1, 2, 3)) < 1e-9);
}

TEST_CASE("rbf: points in a plane, on a line and a single one will do")
{
    auto plane = test::scattered_points(50, 5);
    for (vec3& p : plane) p.z = 0.25 * p.x - p.y + 3;
    const taut::impl::rbf in_plane(plane);
    CHECK(in_plane.polynomial_terms() == 3);
    const auto field = in_plane.solve(plane); // the identity, which is affine
    for (const vec3& p : plane) CHECK(glm::distance(field(p), p) < 1e-9);
    const vec3 between = 0.5 * (plane[0] + plane[1]);
    CHECK(glm::distance(field(between), between) < 1e-9);

    CHECK(taut::impl::rbf(std::vector<vec3>{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}).polynomial_terms() == 2);
    const auto one = taut::impl::rbf(std::vector<vec3>{{1, 2, 3}}).solve(std::vector<vec3>{{4, 5, 6}});
    CHECK(glm::distance(one({9, 9, 9}), vec3(4, 5, 6)) < 1e-9);
}

TEST_CASE("rbf: Wendland's functions get a sparse factorisation, which gives the same field")
{
    const auto points = test::scattered_points(300, 6), values = test::scattered_points(300, 7);
    for (const auto basis : {taut::impl::rbf_basis::wendland_c2, taut::impl::rbf_basis::wendland_c4})
    {
        const taut::impl::rbf dense(points, {.basis = basis, .radius = 0.4}),
            sparse(points, {.basis = basis, .radius = 0.4, .sparse_above = 10});
        CHECK_FALSE(dense.is_sparse());
        CHECK(sparse.is_sparse());
        const auto a = dense.solve(values), b = sparse.solve(values);
        for (const vec3& p : test::scattered_points(20, 8)) CHECK(glm::distance(a(p), b(p)) < 1e-8);
        CHECK(b({100, 0, 0}) == vec3(0.0)); // nothing reaches so far
    }
}

TEST_CASE("rbf: duplicates are merged, what is singular is refused with its points")
{
    auto points = test::scattered_points(20, 9), values = test::scattered_points(20, 10);
    points.push_back(points[3]);
    values.push_back(values[3]);
    const taut::impl::rbf solver(points);
    CHECK(solver.size() == 20);
    CHECK(solver.duplicates() == 1);
    CHECK(glm::distance(solver.solve(values)(points[3]), values[3]) < 1e-9);

    values.back() += vec3(1, 0, 0);
    try
    {
        solver.solve(values);
        FAIL("two values in one place");
    }
    catch (const taut::impl::rbf_error& e)
    {
        CHECK(e.ids() == std::vector<taut::idx>{3, 20});
    }
    points.back() += vec3(1e-11, 0, 0); // not the same, but too near to tell apart
    try
    {
        const taut::impl::rbf near(points, {.basis = taut::impl::rbf_basis::wendland_c4});
        FAIL("singular");
    }
    catch (const taut::impl::rbf_error& e)
    {
        CHECK(e.ids() == std::vector<taut::idx>{3, 20});
    }
    CHECK_THROWS_AS(taut::impl::rbf(std::vector<vec3>{}), parameter_error);
    CHECK_THROWS_AS(taut::impl::rbf(std::vector<vec3>{{0, 0, std::numeric_limits<double>::quiet_NaN()}}),
                    parameter_error);
    CHECK_THROWS_AS(taut::impl::rbf(points, {.radius = -1}), parameter_error);
    CHECK_THROWS_AS(solver.solve(std::vector<vec3>(3)), parameter_error);
}
