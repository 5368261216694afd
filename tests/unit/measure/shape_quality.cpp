// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/impl/core/measure/shape_quality.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/quality.hpp>

using namespace taut;
using namespace taut::impl;

TEST_CASE("shape quality: a regular element has 1, whatever its size and place, and known angles")
{
    for (const double size : {1e-3, 1.0, 1e5})
    {
        const double h = std::sqrt(3) / 2;
        const auto t = shape_of(std::array{size * vec2(5, 5), size * vec2(6, 5), size * vec2(5.5, 5 + h)});
        CHECK(t.mean_ratio == doctest::Approx(1));
        CHECK(t.scaled_jacobian == doctest::Approx(1));
        CHECK(t.min_angle == doctest::Approx(60));
        CHECK(t.max_angle == doctest::Approx(60));

        const auto v = shape_of(
            std::array{size * vec3(1, 1, 1), size * vec3(-1, -1, 1), size * vec3(1, -1, -1), size * vec3(-1, 1, -1)});
        CHECK(std::abs(v.mean_ratio) == doctest::Approx(1));
        CHECK(std::abs(v.scaled_jacobian) == doctest::Approx(1));
        CHECK(v.min_angle == doctest::Approx(std::acos(1.0 / 3) * 180 / std::acos(-1.0)));
        CHECK(v.max_angle == doctest::Approx(v.min_angle));
    }
}

TEST_CASE("shape quality: the corner of a cube, by hand")
{
    const std::array corner{vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)};
    const auto s = shape_of(corner);
    CHECK(s.mean_ratio == doctest::Approx(12 * std::pow(0.5, 2.0 / 3) / 9)); // edges: three of 1, three of sqrt(2)
    CHECK(s.scaled_jacobian == doctest::Approx(std::sqrt(2) / 2));           // the largest product is 2 at corner 1
    CHECK(s.max_angle == doctest::Approx(90));
    CHECK(s.min_angle == doctest::Approx(std::acos(1 / std::sqrt(3)) * 180 / std::acos(-1.0)));

    const auto turned = shape_of(std::array{corner[1], corner[0], corner[2], corner[3]});
    CHECK(turned.mean_ratio == doctest::Approx(-s.mean_ratio));
    CHECK(turned.scaled_jacobian == doctest::Approx(-s.scaled_jacobian));
}

TEST_CASE("shape quality: corners of other cells, 1 where these are regular")
{
    const std::array corner{vec3(1, 1, 1), vec3(3, 1, 1), vec3(1, 3, 1), vec3(1, 1, 3)};
    const auto s = corner_shape(corner, mat3(1.0));
    CHECK(s.mean_ratio == doctest::Approx(1));
    CHECK(s.scaled_jacobian == doctest::Approx(1));
    CHECK(s.min_angle == doctest::Approx(90));
    CHECK(s.max_angle == doctest::Approx(90));
    const auto turned = corner_shape(std::array{corner[0], corner[2], corner[1], corner[3]}, mat3(1.0));
    CHECK(turned.mean_ratio == doctest::Approx(-1));
    CHECK(turned.scaled_jacobian == doctest::Approx(-1));

    // By a simplex that is its own cell, both say the same.
    const auto sheared = std::array{vec3(0, 0, 0), vec3(1, 0.1, 0), vec3(0.3, 1, 0), vec3(0.2, 0.4, 0.8)};
    CHECK(corner_shape(sheared, regular_ideal<tetrahedron>()).mean_ratio ==
          doctest::Approx(shape_of(sheared).mean_ratio));
    const std::array flat{vec2(0, 0), vec2(2, 0), vec2(1, 1)};
    CHECK(corner_shape(flat, regular_ideal<triangle>()).mean_ratio == doctest::Approx(shape_of(flat).mean_ratio));
    CHECK(corner_shape(flat, mat2(1.0)).max_angle == doctest::Approx(45));
}

TEST_CASE("shape quality: a cell of several corners is as good as the worst of them")
{
    const std::vector<vec2> x = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {3, 0}};
    const std::vector<mesh<triangle>::cell> corners = {{0, 1, 3}, {1, 2, 0}, {2, 3, 1}, {3, 0, 2}, {1, 4, 2}};
    const std::vector<idx> owners = {0, 0, 0, 0, 7};
    std::vector<mat2> regular(5, mat2(1.0));
    auto q = measure_shapes<triangle>(corners, x, owners, regular);
    CHECK(q.worst_ids == std::vector<idx>{7, 0});
    CHECK(q.worst.mean_ratio == doctest::Approx(shape_of(std::array{x[1], x[4], x[2]}).mean_ratio));
    auto bent = x;
    bent[2] = {0.4, 0.4};
    q = measure_shapes<triangle>(corners, bent, owners, regular);
    CHECK(q.worst.mean_ratio < 0);
    CHECK(q.worst_ids.front() == 0);
}

TEST_CASE("shape quality: a mesh is told by its worst elements")
{
    const auto m = test::cube(3);
    auto x = m.points();
    const auto before = measure_shapes<tetrahedron>(m.cells(), x);
    CHECK(before.worst_ids.size() == 10);
    CHECK(before.worst.mean_ratio == doctest::Approx(before.mean_ratio)); // all are alike
    x[0] += vec3(0.3);                                                    // towards the middle of its cube
    const auto after = measure_shapes<tetrahedron>(m.cells(), x);
    CHECK(after.worst.mean_ratio < before.worst.mean_ratio);
    const auto& worst = m.cells()[static_cast<std::size_t>(after.worst_ids[0])];
    CHECK(std::find(worst.begin(), worst.end(), 0) != worst.end());
    CHECK(measure_shapes<tetrahedron>(test::single_tetrahedron().cells(), test::single_tetrahedron().points())
              .worst_ids == std::vector<taut::idx>{0});
}
