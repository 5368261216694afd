// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>

#include <taut/deform.hpp>

namespace
{

using namespace taut;
using taut::idx;

/// A bar along z of n by n by 4 n cubes of six tetrahedra, 1 by 1 by 4, its axis that of z.
mesh<tetrahedron> long_bar(int n)
{
    std::vector<vec3> points;
    std::vector<mesh<tetrahedron>::cell> cells;
    const auto at = [n](int i, int j, int k) { return static_cast<idx>((k * (n + 1) + j) * (n + 1) + i); };
    for (int k = 0; k <= 4 * n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) points.emplace_back(double(i) / n - 0.5, double(j) / n - 0.5, double(k) / n);
    for (int k = 0; k < 4 * n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
            {
                const idx a = at(i, j, k), b = at(i + 1, j + 1, k + 1);
                const idx ring[] = {at(i + 1, j, k),     at(i + 1, j + 1, k), at(i, j + 1, k),
                                    at(i, j + 1, k + 1), at(i, j, k + 1),     at(i + 1, j, k + 1)};
                for (std::size_t s = 0; s < 6; ++s) cells.push_back({a, ring[s], ring[(s + 1) % 6], b});
            }
    return {std::move(points), std::move(cells)};
}

std::vector<vec3> twisted(const mesh<tetrahedron>& m, double angle)
{
    std::vector<vec3> x;
    for (const vec3& p : m.points())
    {
        const double c = std::cos(angle * p.z / 4), s = std::sin(angle * p.z / 4);
        x.emplace_back(c * p.x - s * p.y, s * p.x + c * p.y, 1.1 * p.z + 2);
    }
    return x;
}

template <class Points>
double farthest(const Points& x, const Points& y)
{
    double most = 0;
    for (std::size_t v = 0; v < x.size(); ++v) most = std::max(most, glm::distance(x[v], y[v]));
    return most;
}

} // namespace

TEST_CASE("interpolation: the ends are the two shapes bit for bit, a half turn and a whole one are turned half at half")
{
    const auto m = long_bar(5);
    queue q(test::shared_context());
    for (const double angle : {std::numbers::pi, 2 * std::numbers::pi})
    {
        CAPTURE(angle);
        const auto end = twisted(m, angle);
        const interpolation<tetrahedron> between(m, end);
        CHECK(between.at(q, 0).x == m.points());
        CHECK(between.at(q, 1).x == end);
        for (const double t : {0.25, 0.5, 0.75})
        {
            CAPTURE(t);
            const auto r = between.at(q, t);
            REQUIRE(r);
            CHECK(certify<3>(m.cells(), std::span<const vec3>(r.x)));
            CHECK(r.report.converged);
            // Near the twist by part of the angle, but for how the coarse elements shear.
            auto part = twisted(m, t * angle);
            for (std::size_t v = 0; v < part.size(); ++v) part[v].z = (1 + 0.1 * t) * m.points()[v].z + 2 * t;
            CHECK(farthest(r.x, part) < 0.35);
        }
    }
}

TEST_CASE("interpolation: near an end it is near its shape, and a rigid motion is gone rigidly")
{
    const auto m = long_bar(2);
    queue q(test::shared_context());
    const auto end = twisted(m, 1.5);
    const interpolation<tetrahedron> between(m, end);
    CHECK(farthest(between.at(q, 1e-4).x, m.points()) < 1e-3);
    CHECK(farthest(between.at(q, 1 - 1e-4).x, end) < 1e-3);

    const rigid_motion<3> turn{
        .from = vec3(0, 0, 2), .to = vec3(1, 2, 3), .axis = glm::normalize(vec3(1, 2, 0)), .angle = 3};
    std::vector<vec3> moved;
    for (const vec3& p : m.points()) moved.push_back(turn(p));
    const auto r = interpolation<tetrahedron>(m, moved).at(q, 0.5);
    REQUIRE(r);
    CHECK(r.report.energy == doctest::Approx(2).epsilon(1e-6));
    const auto &a = m.points(), &x = r.x;
    for (std::size_t v = 1; v < x.size(); ++v)
        CHECK(glm::distance(x[v], x[0]) == doctest::Approx(glm::distance(a[v], a[0])).epsilon(1e-5));
}

TEST_CASE("interpolation: where the gradients fit no injective shape it finds one all the same")
{
    const auto m = long_bar(5);
    queue q(test::shared_context());
    const auto end = twisted(m, 3 * std::numbers::pi);
    const interpolation<tetrahedron> between(m, end);
    const auto r = between.at(q, 0.5);
    REQUIRE(r);
    CHECK(certify<3>(m.cells(), std::span<const vec3>(r.x)));
}

TEST_CASE("interpolation: in the plane, pins hold, and wrong arguments are refused")
{
    const auto m = test::grid(test::sized(10, 6), test::sized(10, 6));
    queue q(test::shared_context());
    std::vector<vec2> end;
    for (const vec3& p : m.points()) // bent around by three quarters of a turn
        end.emplace_back((1 + p.y) * std::sin(1.5 * std::numbers::pi * p.x),
                         (1 + p.y) * std::cos(1.5 * std::numbers::pi * p.x));
    REQUIRE(certify<2>(m.cells(), std::span<const vec2>(end)));
    const auto pins = taut::constraints(m).pin(0, {0, 0});
    const interpolation<triangle> between(m, end, {.constraints = pins});
    const auto r = between.at(q, 0.5);
    REQUIRE(r);
    CHECK(r.x[0] == vec2(0, 0));
    CHECK(r.report.converged);

    CHECK_THROWS_AS(between.at(q, 1.5), parameter_error);
    CHECK_THROWS_WITH_AS(interpolation<triangle>(m, {vec2(0)}), doctest::Contains("positions"), parameter_error);
    for (vec2& p : end) p.x = -p.x;
    CHECK_THROWS_WITH_AS(interpolation<triangle>(m, end), doctest::Contains("to"), parameter_error);
    CHECK_THROWS_WITH_AS(
        deform(q, m, deform_params<triangle>{.targets = std::vector<mat2>(m.cells().size(), mat2(0.0))}),
        doctest::Contains("targets"), parameter_error);
}
