// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include <taut/impl/core/start/barycentric_map.hpp>

#include "support/meshes.hpp"

namespace
{

using taut::boundary_spacing;
using taut::vec2;
using taut::vec3;
using taut::impl::boundary_polygon;
using taut::impl::boundary_shape;

/// A wavy closed curve in space with uneven steps.
std::vector<vec3> curve(int n)
{
    std::vector<vec3> p;
    for (int k = 0; k < n; ++k)
    {
        const double t = 2 * std::numbers::pi * std::pow(static_cast<double>(k) / n, 1.5);
        p.emplace_back(3 * std::cos(t), std::sin(t), 0.2 * std::sin(5 * t));
    }
    return p;
}

double area(const std::vector<vec2>& p)
{
    double sum = 0;
    for (std::size_t k = 0; k < p.size(); ++k)
    {
        const vec2 q = p[(k + 1) % p.size()];
        sum += (p[k].x * q.y - p[k].y * q.x) / 2;
    }
    return sum;
}

double perimeter(const std::vector<vec2>& p)
{
    double sum = 0;
    for (std::size_t k = 0; k < p.size(); ++k) sum += glm::distance(p[k], p[(k + 1) % p.size()]);
    return sum;
}

int turn(const std::vector<vec2>& p, std::size_t k)
{
    return taut::impl::orient2d(p[k], p[(k + 1) % p.size()], p[(k + 2) % p.size()]);
}

} // namespace

TEST_CASE("boundary polygon: convex, counter-clockwise and of the given area for every shape and spacing")
{
    for (const int n : {3, 4, 5, 6, 7, 50, 1001})
        for (const auto shape : {boundary_shape::circle, boundary_shape::square})
            for (const auto spacing :
                 {boundary_spacing::uniform, boundary_spacing::chord, boundary_spacing::centripetal})
            {
                CAPTURE(n);
                const auto p = boundary_polygon(curve(n), {shape, spacing}, 7.0);
                REQUIRE(p.size() == static_cast<std::size_t>(n));
                CHECK(area(p) == doctest::Approx(7));
                for (std::size_t k = 0; k < p.size(); ++k)
                    CHECK(turn(p, k) >= (shape == boundary_shape::circle || n == 3 ? 1 : 0));
            }
}

TEST_CASE("boundary polygon: a circle has the spacing asked for")
{
    const auto loop = curve(30);
    const auto arc = [&](boundary_spacing spacing, std::size_t k)
    {
        const auto p = boundary_polygon(loop, {boundary_shape::circle, spacing}, 1.0);
        const vec2 a = p[k];
        const vec2 b = p[(k + 1) % 30];
        return std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b));
    };
    const auto length = [&](std::size_t k) { return glm::distance(loop[k], loop[(k + 1) % 30]); };
    CHECK(arc(boundary_spacing::uniform, 3) == doctest::Approx(2 * std::numbers::pi / 30));
    CHECK(arc(boundary_spacing::chord, 3) / arc(boundary_spacing::chord, 20) ==
          doctest::Approx(length(3) / length(20)));
    CHECK(arc(boundary_spacing::centripetal, 3) / arc(boundary_spacing::centripetal, 20) ==
          doctest::Approx(std::sqrt(length(3) / length(20))));
}

TEST_CASE("boundary polygon: a square has four right corners at vertices and straight sides")
{
    for (const int n : {4, 5, 6, 7, 9, 200})
    {
        CAPTURE(n);
        const auto p = boundary_polygon(curve(n), {boundary_shape::square, boundary_spacing::chord}, 4.0);
        int corners = 0;
        for (std::size_t k = 0; k < p.size(); ++k)
            if (turn(p, k) != 0)
            {
                ++corners;
                const vec2 corner = p[(k + 1) % p.size()];
                CHECK(std::abs(corner.x) == doctest::Approx(1));
                CHECK(std::abs(corner.y) == doctest::Approx(1));
            }
        CHECK(corners == 4);
        CHECK(perimeter(p) == doctest::Approx(8));
    }
}

TEST_CASE("boundary polygon: corners move to where no interior edge lies along a side")
{
    // Twelve vertices; one ear at vertex 2 (edge 1-3). Corners at 0, 3, 6, 9 would put the ear on a side.
    std::vector<vec3> loop;
    for (int k = 0; k < 12; ++k)
        loop.emplace_back(std::cos(k * std::numbers::pi / 6), std::sin(k * std::numbers::pi / 6), 0);
    const std::vector<std::pair<std::size_t, std::size_t>> ear{{1, 3}};
    const auto p = boundary_polygon(loop, {boundary_shape::square, boundary_spacing::uniform}, 4.0, ear);
    CHECK(turn(p, 1) == 1); // vertex 2 is a corner
    int corners = 0;
    for (std::size_t k = 0; k < 12; ++k) corners += turn(p, k);
    CHECK(corners == 4); // and the sides are straight
}

TEST_CASE("boundary polygon: sides that cannot avoid an interior edge are bent outwards")
{
    std::vector<vec3> loop;
    for (int k = 0; k < 16; ++k)
        loop.emplace_back(std::cos(k * std::numbers::pi / 8), std::sin(k * std::numbers::pi / 8), 0);
    // Ears at every even vertex: more than four corners can take.
    std::vector<std::pair<std::size_t, std::size_t>> ears;
    for (std::size_t k = 1; k < 16; k += 2) ears.emplace_back(k, (k + 2) % 16);
    const auto p = boundary_polygon(loop, {boundary_shape::square, boundary_spacing::uniform}, 4.0, ears);
    CHECK(area(p) == doctest::Approx(4));
    for (const auto& [a, b] : ears) CHECK(taut::impl::orient2d(p[a], p[(a + 1) % 16], p[b]) == 1);
    for (std::size_t k = 0; k < 16; ++k) CHECK(turn(p, k) >= 0);
}

TEST_CASE("boundary polygon: tiny steps are evened out until rounding keeps the circle convex")
{
    std::vector<vec3> loop{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    for (int k = 0; k < 5; ++k) loop.emplace_back(0, 1 - k * 1e-11, 0);
    const auto p = boundary_polygon(loop, {boundary_shape::circle, boundary_spacing::chord}, 1.0);
    for (std::size_t k = 0; k < p.size(); ++k) CHECK(turn(p, k) == 1);
    CHECK(glm::distance(p[0], p[1]) == doctest::Approx(glm::distance(p[1], p[2])).epsilon(0.01));
}

TEST_CASE("boundary polygon: refuses what is no loop or no area")
{
    CHECK_THROWS_AS(boundary_polygon(std::vector<vec3>{{0, 0, 0}, {1, 0, 0}}, {}, 1.0), taut::parameter_error);
    CHECK_THROWS_AS(boundary_polygon(curve(5), {}, 0.0), taut::parameter_error);
    CHECK_THROWS_AS(boundary_polygon(curve(5), {}, std::nan("")), taut::parameter_error);
}
