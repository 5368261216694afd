// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include <taut/impl/atlas/atlas_summary.hpp>
#include <taut/impl/atlas/convex_relaxing.hpp>
#include <taut/impl/atlas/round_polygon.hpp>
#include <taut/impl/atlas/settled_charts.hpp>
#include <taut/impl/core/single.hpp>
#include <taut/impl/io/obj.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using namespace taut::impl;

vec2 rounded(vec2 p)
{
    return {in_single(p.x), in_single(p.y)};
}

chart_mesh charts_of(const mesh<triangle>& m)
{
    const auto f = facets(m);
    return cut_charts(m, f, std::vector<char>(f.twin.size(), 0));
}

} // namespace

TEST_CASE("settled charts: only those that rounding spoils are moved, and only as far as they may be")
{
    // Two strips; the second one is a needle.
    std::vector<vec3> points;
    std::vector<vec2> uv;
    std::vector<std::array<taut::idx, 3>> cells;
    for (const double height : {0.1, 1e-10})
    {
        const auto first = static_cast<taut::idx>(points.size());
        for (int k = 0; k < 8; ++k)
        {
            const vec2 p(0.1 + 0.11 * (k / 2), 0.3 + height * (k % 2) + (first > 0 ? 0.4 : 0));
            uv.push_back({0.8 * p.x - 0.1 * p.y + 0.1, 0.1 * p.x + 0.8 * p.y});
            points.emplace_back(p.x, p.y, 0);
        }
        for (taut::idx k = first; k + 2 < first + 8; k += 2)
        {
            cells.push_back({k, k + 2, k + 1});
            cells.push_back({k + 1, k + 2, k + 3});
        }
    }
    const auto charts = charts_of(mesh<triangle>(points, cells));
    REQUIRE(charts.charts() == 2);
    auto settled = uv;
    const auto bad = settle_charts(charts, {}, settled, {.stored = rounded, .reach = 1e-6});
    CHECK(bad == std::vector<char>{0, 0});
    for (std::size_t v = 0; v < uv.size(); ++v)
    {
        CHECK(settled[v] == rounded(settled[v]));
        CHECK(glm::length(settled[v] - uv[v]) <= 1e-6);
        if (v < 8) CHECK(settled[v] == rounded(uv[v]));
    }
    CHECK(turned_triangle(charts, 1, settled) < 0);
    auto stuck = uv;
    CHECK(settle_charts(charts, {}, stuck, {.stored = rounded, .reach = 3e-8}) == std::vector<char>{0, 1});
}

TEST_CASE("convex polygons: maps follow while all corners keep turning left")
{
    // A grid of quads; in the plane one of them has a corner that turns right.
    constexpr taut::idx n = 4;
    std::vector<vec3> points;
    std::vector<vec2> uv;
    for (taut::idx y = 0; y <= n; ++y)
        for (taut::idx x = 0; x <= n; ++x)
        {
            points.emplace_back(x, y, 0);
            uv.emplace_back(x, y);
        }
    std::vector<std::array<taut::idx, 3>> cells;
    std::vector<taut::idx> label;
    for (taut::idx y = 0; y < n; ++y)
        for (taut::idx x = 0; x < n; ++x)
        {
            const taut::idx a = y * (n + 1) + x, b = a + 1, c = b + n + 1, d = c - 1;
            cells.push_back({a, b, c});
            cells.push_back({a, c, d});
            label.insert(label.end(), 2, y * n + x);
        }
    const auto charts = charts_of(mesh<triangle>(points, cells));
    const auto polygons = find_convex_polygons(cells, label, points);
    REQUIRE(polygons.size() == n * n);
    uv[2 * (n + 1) + 3] = {2.3, 2.2}; // between its neighbours to the left and below, so that its corner turns right
    uv[2 * (n + 1) + 2] = {2.3, 2.6};
    REQUIRE(turned_triangle(charts, 0, uv) < 0);
    REQUIRE(charts_with_concave(charts, polygons, uv) == std::vector<char>{1});
    CHECK(settle_charts(charts, polygons, uv, {}) == std::vector<char>{0});
    CHECK(charts_with_concave(charts, polygons, uv) == std::vector<char>{0});
    const ideal_elements<triangle> ideal(charts.surface);
    const double settled = area_and_energy(charts, 0, uv, ideal).second;
    relax_convex(charts, 0, polygons, uv, [] { return true; });
    CHECK(turned_triangle(charts, 0, uv) < 0);
    CHECK(charts_with_concave(charts, polygons, uv) == std::vector<char>{0});
    CHECK(area_and_energy(charts, 0, uv, ideal).second < 4 + 0.01 * (settled - 4));
}

TEST_CASE("round polygons: whatever a polygon is in space, its triangles are positive on a circle")
{
    std::string text, face = "f";
    for (int k = 0; k < 17; ++k)
    {
        const double a = 2 * std::numbers::pi * k / 17, r = k % 3 == 0 ? 0.3 : 1 + 0.2 * (k % 5);
        text += "v " + std::to_string(r * std::cos(a)) + ' ' + std::to_string(r * std::sin(a)) + ' ' +
                std::to_string(3 * std::sin(5.0 * k)) + '\n';
        face += ' ' + std::to_string(k + 1);
    }
    const auto m = io::impl::parse_obj(text + face).surface;
    const auto charts = charts_of(m);
    std::vector<vec2> uv(charts.surface.points().size(), vec2(0.0));
    lay_round(charts, 0, uv);
    CHECK(turned_triangle(charts, 0, uv) < 0);
    CHECK_FALSE(overlaps_itself(charts, 0, uv));
}
