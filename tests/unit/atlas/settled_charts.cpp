// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include <taut/impl/charts/atlas/atlas_summary.hpp>
#include <taut/impl/charts/atlas/chart_start.hpp>
#include <taut/impl/charts/atlas/settled_charts.hpp>
#include <taut/impl/core/core/single.hpp>
#include <taut/impl/files/surface/obj.hpp>

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
