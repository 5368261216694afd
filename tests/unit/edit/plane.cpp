// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/rbf_points.hpp>
#include <taut/impl/charts/paste/surface/plane_triangulation.hpp>
#include <taut/impl/charts/paste/surface/polygon_filling.hpp>
#include <taut/impl/charts/paste/surface/surface_tree.hpp>

using namespace taut;

namespace
{

/// n corners around (0, 0), at random distances from low to high.
std::vector<vec2> star(int n, double low, double high, std::mt19937& random)
{
    std::vector<vec2> corners;
    for (int i = 0; i < n; ++i)
    {
        const double a = 2 * std::numbers::pi * i / n, r = low + (high - low) * double(random()) / 4294967296.0;
        corners.emplace_back(r * std::cos(a), r * std::sin(a));
    }
    return corners;
}

double area_of(const std::vector<vec2>& polygon)
{
    double area = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
        const vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        area += (a.x * b.y - a.y * b.x) / 2;
    }
    return area;
}

/// The sum of areas; every triangle must be positive.
double area_of(const std::vector<std::array<taut::idx, 3>>& cells, const std::vector<vec2>& x)
{
    double area = 0;
    for (const auto& t : cells)
    {
        const auto o = taut::impl::orient(x[std::size_t(t[0])], x[std::size_t(t[1])], x[std::size_t(t[2])]);
        CHECK(o.sign > 0);
        area += o.det / 2;
    }
    return area;
}

std::vector<taut::idx> numbers_from(std::size_t first, std::size_t n)
{
    std::vector<taut::idx> loop;
    for (std::size_t i = 0; i < n; ++i) loop.push_back(static_cast<taut::idx>(first + i));
    return loop;
}

} // namespace

TEST_CASE("ring between two polygons: filled with positive triangles of their corners, then Delaunay")
{
    std::mt19937 random(1);
    for (const int n : {3, 4, 7, 40, 200})
    {
        auto x = star(n, 0.6, 1, random);
        const auto inner = star(n + 2, 0.1, 0.25, random);
        const double expected = area_of(x) - area_of(inner);
        const auto outer_loop = numbers_from(0, x.size()), inner_loop = numbers_from(x.size(), inner.size());
        x.insert(x.end(), inner.begin(), inner.end());
        const auto polygon = impl::bridged(outer_loop, inner_loop, x);
        REQUIRE(polygon.size() == x.size() + 2);
        const auto filling = impl::clip_ears(polygon, x);
        CHECK(filling.size() == x.size());
        CHECK(area_of(filling, x) == doctest::Approx(expected));
        const impl::plane_triangulation better(x, filling);
        CHECK(better.triangles().size() == filling.size());
        CHECK(area_of(better.triangles(), x) == doctest::Approx(expected));
    }
}

TEST_CASE("polygons with corners on straight sides are filled, those that cross themselves are told")
{
    const std::vector<vec2> square{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
    const auto filling = impl::clip_ears(numbers_from(0, 8), square);
    CHECK(filling.size() == 6);
    CHECK(area_of(filling, square) == doctest::Approx(4));
    const std::vector<vec2> eight{{0, 0}, {1, 1}, {1, 0}, {0, 1}};
    CHECK(impl::clip_ears(numbers_from(0, 4), eight).size() < 2);
    CHECK(impl::encloses(square, {1, 1}));
    CHECK(impl::encloses(square, {2, 1.5}));
    CHECK_FALSE(impl::encloses(square, {2.001, 1.5}));
    CHECK(impl::distance_from(square, {1, 0.25}) == doctest::Approx(0.25));
}

TEST_CASE("points are inserted where they are inside, and no circle around a triangle has another one in it")
{
    std::mt19937 random(2);
    auto polygon = star(30, 0.9, 1, random);
    const double area = area_of(polygon);
    impl::plane_triangulation plane(polygon, impl::clip_ears(numbers_from(0, 30), polygon));
    int inserted = 0;
    for (int k = 0; k < 200; ++k)
        inserted += plane.insert({double(random()) / 4294967296.0 - 0.5, double(random()) / 4294967296.0 - 0.5});
    CHECK(inserted == 200);
    CHECK_FALSE(plane.insert({5, 5}));
    CHECK_FALSE(plane.insert(plane.points()[40])); // there is one
    CHECK(plane.insert(0.5 * (plane.points()[40] + plane.points()[41])));
    CHECK(plane.triangles().size() == 28 + 2 * 201);
    CHECK(area_of(plane.triangles(), plane.points()) == doctest::Approx(area));
    int broken = 0;
    for (const auto& t : plane.triangles())
    {
        const vec2 a = plane.points()[std::size_t(t[0])], b = plane.points()[std::size_t(t[1])] - a,
                   c = plane.points()[std::size_t(t[2])] - a;
        const double d = 2 * (b.x * c.y - b.y * c.x);
        const vec2 to_centre =
            vec2(c.y * glm::dot(b, b) - b.y * glm::dot(c, c), b.x * glm::dot(c, c) - c.x * glm::dot(b, b)) / d;
        if (std::max({t[0], t[1], t[2]}) < 30 || glm::length(a + to_centre) + glm::length(to_centre) > 0.9)
            continue; // the boundary may cut the circle
        for (const vec2& p : plane.points())
            broken += glm::distance(p, a + to_centre) < (1 - 1e-6) * glm::length(to_centre);
    }
    CHECK(broken == 0);
}

TEST_CASE("nearest point: a tree of boxes finds what all triangles have")
{
    const auto m = test::bumpy(12);
    const impl::surface_tree tree(m.points(), m.cells());
    for (const vec3& p : test::scattered_points(100, 1, 2.0))
    {
        double expected = std::numeric_limits<double>::infinity();
        for (taut::idx f = 0; f < m.cell_count(); ++f)
        {
            const auto x = m.rest(f);
            const vec3 w = impl::nearest_weights(p, x[0], x[1], x[2]);
            CHECK(std::min({w.x, w.y, w.z}) >= 0);
            expected = std::min(expected, glm::distance(p, w.x * x[0] + w.y * x[1] + w.z * x[2]));
        }
        const auto found = tree.nearest(p);
        CHECK(found.distance == expected);
        CHECK(glm::distance(found.of(m.cells(), m.points()), p) == doctest::Approx(expected));
    }
}
