// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <doctest/doctest.h>

#include <taut/impl/core/measure/singular_values.hpp>
#include <taut/quality.hpp>

#include "support/meshes.hpp"

namespace
{

using doctest::Approx;
using taut::mat2;
using taut::mat3;
using taut::vec2;
using taut::vec3;

/// The planar image of a planar mesh under a linear map.
std::vector<vec2> image(const taut::mesh<taut::triangle>& m, const mat2& A)
{
    std::vector<vec2> x;
    for (const auto& p : m.points()) x.push_back(A * vec2(p));
    return x;
}

mat2 rotation(double angle)
{
    return {std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle)};
}

} // namespace

TEST_CASE("quality: an isometry has no distortion in any measure")
{
    const auto m = taut::test::bumpy(6, 0.0, 1);
    const auto q = taut::measure_quality<taut::triangle>(m, image(m, rotation(0.7)));
    CHECK(q.flips.flipped == 0);
    CHECK(q.isometric.uniform == Approx(4));
    CHECK(q.isometric.measure == Approx(4));
    CHECK(q.shape.uniform == Approx(1));
    CHECK(q.area.measure == Approx(2));
    CHECK(q.scale == Approx(1));
    CHECK(q.stretch_l2.min == Approx(1));
    CHECK(q.stretch_l2.max == Approx(1));
    CHECK(q.stretch_l2.rms < 1e-12);
    CHECK(q.stretch_l2_total == Approx(1));
    CHECK(q.stretch_linf.max == Approx(1));
    CHECK(q.area_ratio.rms < 1e-12);
    CHECK(q.angular < 1e-20);
}

TEST_CASE("quality: angles are those of meshes of any size")
{
    const auto m = taut::test::bumpy(6, 0.3, 1);
    const mat2 sheared(1, 0, 0.5, 1);
    const double usual = taut::measure_quality<taut::triangle>(m, image(m, sheared)).angular;
    for (const double size : {1e-300, 1e-160, 1e160, 1e300})
    {
        CAPTURE(size);
        auto points = m.points();
        for (vec3& p : points) p *= size;
        const taut::mesh<taut::triangle> sized(points, m.cells());
        CHECK(taut::measure_quality<taut::triangle>(sized, image(sized, sheared)).angular == Approx(usual));
    }
}

TEST_CASE("quality: a similarity is seen by energies only; stretch, area and angles are free of scale")
{
    const auto m = taut::test::bumpy(6, 0.0, 1);
    const auto q = taut::measure_quality<taut::triangle>(m, image(m, 3.0 * rotation(-0.2)));
    CHECK(q.scale == Approx(1.0 / 3));
    CHECK(q.flips.min_det == Approx(9));
    CHECK(q.isometric.measure == Approx(18 * (1 + 1.0 / 81)));
    CHECK(q.shape.measure == Approx(1));
    CHECK(q.area.uniform == Approx(9 + 1.0 / 9));
    CHECK(q.stretch_l2.max == Approx(1));
    CHECK(q.stretch_linf.rms < 1e-12);
    CHECK(q.area_ratio.min == Approx(1));
    CHECK(q.angular < 1e-20);
}

TEST_CASE("quality: a stretch by two in one direction")
{
    const auto m = taut::test::bumpy(6, 0.0, 1);
    const auto q = taut::measure_quality<taut::triangle>(m, image(m, mat2(2, 0, 0, 1)));
    // sigma = (2, 1), after scaling to the same area (sqrt 2, 1 / sqrt 2).
    CHECK(q.isometric.uniform == Approx(5 * (1 + 0.25)));
    CHECK(q.shape.uniform == Approx(1.25));
    CHECK(q.area.uniform == Approx(2.5));
    CHECK(q.scale == Approx(std::sqrt(0.5)));
    CHECK(q.stretch_l2.min == Approx(std::sqrt(1.25)));
    CHECK(q.stretch_l2.rms == Approx(std::sqrt(1.25) - 1));
    CHECK(q.stretch_l2_total == Approx(std::sqrt(1.25)));
    CHECK(q.stretch_linf.max == Approx(std::sqrt(2.0)));
    CHECK(q.area_ratio.max == Approx(1));
}

TEST_CASE("quality: area ratios and means of two triangles with different fates")
{
    // A unit square of two equal triangles; the right one is sheared out so that it doubles.
    const taut::mesh<taut::triangle> m({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 2, 3}, {0, 1, 2}});
    const auto q =
        taut::measure_quality<taut::triangle>(m, std::vector<vec2>{{0, 0}, {2, 0}, {1, 1}, {0, 1}}); // areas 0.5 and 1
    CHECK(q.scale == Approx(std::sqrt(1 / 1.5)));
    CHECK(q.area_ratio.min == Approx(1 / 1.5));
    CHECK(q.area_ratio.max == Approx(2 / 1.5));
    CHECK(q.area_ratio.rms == Approx(1 / 3.0));
    CHECK(q.flips.max_det == Approx(2));
    // Angles (90, 45, 45) become (45, 90, 45) in the second triangle, order 0 1 2: 45, 90, 45 -> 45, 45, 90.
    CHECK(q.angular == Approx((0.25 + 1.0) / 6));
}

TEST_CASE("quality: uniform and area means differ where big triangles are distorted more")
{
    const std::vector<double> value{1, 5};
    const auto m = taut::impl::mean(value, std::vector<double>{3, 1});
    CHECK(m.uniform == Approx(3));
    CHECK(m.measure == Approx(2));
}

TEST_CASE("quality: a mirrored map is infinite in the energies and flipped everywhere")
{
    const auto m = taut::test::grid(3, 3);
    const auto q = taut::measure_quality<taut::triangle>(m, image(m, mat2(-1, 0, 0, 1)));
    CHECK(q.flips.flipped == m.cells().size());
    CHECK(std::isinf(q.isometric.uniform));
    CHECK(std::isinf(q.shape.measure));
    CHECK(q.stretch_l2.max == Approx(1));
    CHECK(q.area_ratio.max == Approx(1));
}

TEST_CASE("quality: tetrahedra under rotation, dilation and stretch")
{
    const auto m = taut::test::cube(2);
    const auto image3 = [&m](const mat3& A)
    {
        std::vector<vec3> x;
        for (const auto& p : m.points()) x.push_back(A * p);
        return x;
    };
    const mat3 R(0, 1, 0, 0, 0, 1, 1, 0, 0); // a turn of the axes
    const auto turned = taut::measure_quality<taut::tetrahedron>(m, image3(R));
    CHECK(turned.isometric.uniform == Approx(2));
    CHECK(turned.stretch_l2.max == Approx(1));
    CHECK(turned.angular < 1e-20);
    const auto grown = taut::measure_quality<taut::tetrahedron>(m, image3(2.0 * R));
    CHECK(grown.scale == Approx(0.5));
    CHECK(grown.isometric.measure == Approx(8.125));
    CHECK(grown.stretch_linf.max == Approx(1));
    const auto stretched = taut::measure_quality<taut::tetrahedron>(m, image3(mat3(8, 0, 0, 0, 1, 0, 0, 0, 1)));
    CHECK(stretched.flips.min_det == Approx(8));
    CHECK(stretched.stretch_linf.max == Approx(2)); // sigma / 2
    CHECK(stretched.stretch_l2.max == Approx(std::sqrt((4 + 4 + 1.0 / 16) / 3)));
}

TEST_CASE("distortion: one value a cell, infinite exactly where it is flipped")
{
    const auto m = taut::test::grid(2, 2);
    auto x = image(m, mat2(1));
    const auto still = taut::distortion<taut::triangle>(m, x);
    REQUIRE(still.size() == 8);
    for (const double e : still) CHECK(e == Approx(4));
    x[4] = {0.5, 1.5};
    const auto moved = taut::distortion<taut::triangle>(m, x);
    const auto flips = taut::certify<2>(m.cells(), x);
    std::size_t infinite = 0;
    for (const double e : moved) infinite += std::isinf(e) ? 1U : 0U;
    CHECK(infinite == flips.flipped);
    CHECK(infinite > 0);
}

TEST_CASE("singular values: known matrices, orders and small values")
{
    const auto s = taut::impl::singular_values<2>(mat2(0, 3, -2, 0));
    CHECK(s[0] == Approx(3));
    CHECK(s[1] == Approx(2));
    CHECK(taut::impl::singular_values<2>(mat2(1, 1, 1, 1))[1] < 1e-15);
    CHECK(taut::impl::singular_values<2>(mat2(0.0))[0] == 0);
    // diag(1, 1e-12) between two rotations: the small value survives with relative accuracy.
    const auto t = taut::impl::singular_values<2>(mat2(1, 0, 0, 1e-12) * rotation(0.3));
    CHECK(t[1] == Approx(1e-12).epsilon(1e-10));
}

TEST_CASE_TEMPLATE("singular values: their product is |det| and their squares sum to |M|^2", D,
                   std::integral_constant<int, 2>, std::integral_constant<int, 3>)
{
    constexpr int n = D::value;
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int k = 0; k < 200; ++k)
    {
        taut::mat<n> M;
        double norm2 = 0;
        for (int c = 0; c < n; ++c)
            for (int r = 0; r < n; ++r)
            {
                M[c][r] = normal(random);
                norm2 += M[c][r] * M[c][r];
            }
        const auto s = taut::impl::singular_values<n>(M);
        double product = 1;
        double sum = 0;
        for (const double x : s)
        {
            product *= x;
            sum += x * x;
        }
        CHECK(product == Approx(std::abs(glm::determinant(M))).epsilon(1e-9));
        CHECK(sum == Approx(norm2));
        CHECK(s[0] >= s[n - 1]);
    }
}
