// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include <support/closed_meshes.hpp>
#include <support/meshes.hpp>
#include <taut/certify.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/charts/atlas/crossing_charts.hpp>
#include <taut/impl/charts/atlas/seen_patches.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/mesh.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

/// A strip of n squares, whose middle line is laid at the angles 0 .. turn of circles about the origin.
std::vector<vec2> arc_of(int n, double turn, double radius, double growth)
{
    std::vector<vec2> uv;
    for (int i = 0; i <= n; ++i)
        for (const double side : {0.5, -0.5})
        {
            const double a = turn * i / n, r = radius + growth * a + side;
            uv.push_back({r * std::cos(a), r * std::sin(a)});
        }
    return uv;
}

mesh<triangle> strip(int n)
{
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    for (int i = 0; i <= n; ++i)
        for (const double y : {0.0, 1.0}) points.push_back({double(i), y, 0.0});
    for (idx i = 0; i < n; ++i)
    {
        cells.push_back({2 * i, 2 * i + 2, 2 * i + 3});
        cells.push_back({2 * i, 2 * i + 3, 2 * i + 1});
    }
    return {points, cells};
}

bool crosses(const mesh<triangle>& m, const std::vector<vec2>& uv)
{
    const auto f = facets(m);
    const auto charts = cut_charts(m, f, std::vector<char>(f.twin.size(), 0));
    REQUIRE(certify<2>(m.cells(), std::span<const vec2>(uv)));
    return impl::crossing_charts(charts, uv)[0] != 0;
}

} // namespace

TEST_CASE("crossing charts: a strip that runs over itself, and spirals that do not")
{
    constexpr double turn = 2.5 * std::numbers::pi;
    const auto m = strip(40);
    CHECK(crosses(m, arc_of(40, turn, 3, 0)));
    CHECK_FALSE(crosses(m, arc_of(40, turn, 3, 0.5)));
    CHECK_FALSE(crosses(m, arc_of(40, 1, 3, 0)));
}

TEST_CASE("crossing charts: three triangles about a corner that go around it more than once")
{
    const mesh<triangle> fan({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                             {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
    for (const double angle : {1.0, 2.0, 2.2})
    {
        std::vector<vec2> uv{{0, 0}};
        for (int k = 0; k < 4; ++k) uv.emplace_back(std::cos(k * angle), std::sin(k * angle));
        CHECK(crosses(fan, uv) == (3 * angle > 2 * std::numbers::pi));
    }
}

TEST_CASE(
    "crossing charts: an annulus around its hole, and one whose loops do not meet though it covers its middle twice")
{
    const auto m = test::annulus(12);
    std::vector<vec2> uv;
    for (const vec3& p : m.points()) uv.push_back(vec2(p));
    CHECK_FALSE(crosses(m, uv));

    const std::vector<std::vector<idx>> loops{{0, 1, 2}, {3, 4, 5}}, hole{{0, 1, 2}, {5, 4, 3}};
    const std::vector<vec2> nested{{-3, -3}, {3, -3}, {0, 4}, {-1, -1}, {1, -1}, {0, 1}};
    CHECK(impl::overlaps_itself(loops, nested));
    CHECK_FALSE(impl::overlaps_itself(hole, nested));
}

TEST_CASE("chart borders: the loops of each chart, as those of all charts together")
{
    for (const auto& m : {test::ball(8), test::pierced_plate(2, 3), test::noisy(test::torus(16, false), 0.1),
                          test::grid(5, 4), test::single_triangle()})
    {
        const auto f = facets(m);
        for (const std::size_t largest : {1000U, 7U, 1U})
        {
            const std::vector<char> all(m.cells().size(), 1);
            const auto charts = cut_charts(m, f, seams_between(f, impl::lay_as_seen(m, f, all, {}, largest).patch));
            std::vector<std::vector<idx>> loops;
            for (idx k = 0; k < charts.charts(); ++k)
                for (auto& loop : impl::border_loops(charts, k)) loops.push_back(std::move(loop));
            CHECK((loops == boundary_loops(charts.surface)));
        }
    }
}

TEST_CASE("chart borders: a vertex with very many triangles")
{
    constexpr idx n = 200'000;
    std::vector<vec3> points{{0, 0, 0}};
    std::vector<std::array<idx, 3>> cells;
    for (idx i = 0; i < n; ++i)
    {
        const double a = 2 * std::numbers::pi * i / n;
        points.emplace_back(std::cos(a), std::sin(a), 0);
        cells.push_back({0, 1 + i, 1 + (i + 1) % n});
    }
    const mesh<triangle> wheel(std::move(points), std::move(cells));
    const auto f = facets(wheel);
    const auto charts = cut_charts(wheel, f, std::vector<char>(f.twin.size(), 0));
    CHECK((impl::border_loops(charts, 0) == boundary_loops(charts.surface)));
}
