// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>

#include <taut/rigid_motion.hpp>
#include <taut/smooth.hpp>

namespace
{

using namespace taut;
using taut::idx;

mesh<tetrahedron> turned(const mesh<tetrahedron>& m)
{
    const rigid_motion<3> turn{.from = vec3(0), .to = vec3(2, 0, 1), .axis = glm::normalize(vec3(1, 3, 2)), .angle = 1};
    auto points = m.points();
    for (vec3& p : points) p = turn(p);
    return {std::move(points), m.cells()};
}

} // namespace

TEST_CASE("smooth: elements get better, the worst most of all, and the boundary keeps its shape")
{
    const auto m = test::jittered_cube(test::sized(8, 4), 1);
    queue q(test::shared_context());
    for (const auto boundary : {smooth_boundary::fixed, smooth_boundary::sliding, smooth_boundary::free})
    {
        CAPTURE(static_cast<int>(boundary));
        const auto r = smooth(q, m, {.boundary = boundary});
        REQUIRE(r);
        CHECK(r.report.converged);
        CHECK(certify<3>(m.cells(), r.x));
        CHECK(r.after.mean_ratio > r.before.mean_ratio);
        CHECK(r.after.worst.mean_ratio > 1.2 * r.before.worst.mean_ratio);
        CHECK(r.after.worst.min_angle > r.before.worst.min_angle);
        bool sides = true, same = true;
        for (std::size_t v = 0; v < r.x.size(); ++v)
            for (int k = 0; k < 3; ++k)
                if (const double c = m.points()[v][k]; c == 0 || c == 1)
                {
                    sides = sides && r.x[v][k] == c;
                    same = same && r.x[v] == m.points()[v];
                }
        CHECK(sides == (boundary != smooth_boundary::free));
        CHECK(same == (boundary == smooth_boundary::fixed));
    }
}

TEST_CASE("smooth: flat sides and straight creases of any direction slide in themselves")
{
    const auto m = test::jittered_cube(test::sized(6, 4), 1);
    queue q(test::shared_context());
    const auto straight = smooth(q, m), slanted = smooth(q, turned(m));
    REQUIRE(straight);
    REQUIRE(slanted);
    CHECK(slanted.report.energy == doctest::Approx(straight.report.energy).epsilon(1e-6));
    const auto wanted = turned({straight.x, m.cells()});
    double off = 0;
    for (std::size_t v = 0; v < wanted.points().size(); ++v)
        off = std::max(off, glm::distance(wanted.points()[v], slanted.x[v]));
    CHECK(off < 1e-3);
}

TEST_CASE("smooth: a tangled mesh becomes a good one, fixed vertices stay")
{
    const auto m = test::jittered_cube(test::sized(6, 4), 1);
    auto points = m.points();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> move(-0.2, 0.2);
    std::vector<idx> inside;
    for (idx v = 0; v < m.vertex_count(); ++v)
    {
        vec3& p = points[static_cast<std::size_t>(v)];
        if (std::min({p.x, p.y, p.z}) > 0 && std::max({p.x, p.y, p.z}) < 1) inside.push_back(v);
    }
    for (const idx v : inside) points[static_cast<std::size_t>(v)] += vec3(move(random), move(random), move(random));
    const idx still = inside.front();
    points[static_cast<std::size_t>(still)] = m.points()[static_cast<std::size_t>(still)];
    const mesh<tetrahedron> tangled(points, m.cells());
    queue q(test::shared_context());
    const auto r = smooth(q, tangled, {.worst_exponent = 3, .fixed = {still}});
    REQUIRE(r);
    CHECK(r.before.worst.mean_ratio < 0);
    CHECK(r.after.worst.mean_ratio > 0.2);
    CHECK(r.x[static_cast<std::size_t>(still)] == points[static_cast<std::size_t>(still)]);
}

TEST_CASE("smooth: a mesh of the plane, and wrong parameters")
{
    auto m = test::grid(test::sized(12, 6), test::sized(12, 6));
    auto points = m.points();
    std::mt19937 random(4);
    std::uniform_real_distribution<double> move(-0.02, 0.02);
    for (vec3& p : points)
        for (int k = 0; k < 2; ++k)
            if (p[k] > 0 && p[k] < 1) p[k] += move(random);
    m = mesh<triangle>(points, m.cells());
    queue q(test::shared_context());
    const auto r = smooth(q, m);
    REQUIRE(r);
    CHECK(r.after.mean_ratio > r.before.mean_ratio);
    for (std::size_t v = 0; v < r.x.size(); ++v)
        for (int k = 0; k < 2; ++k)
            if (points[v][k] == 0 || points[v][k] == 1) CHECK(r.x[v][k] == points[v][k]);

    CHECK_THROWS_WITH_AS(smooth(q, m, {.worst_exponent = 0}), doctest::Contains("worst_exponent"), parameter_error);
    CHECK_THROWS_AS(smooth(q, m, {.fixed = {-1}}), constraint_error);
}
