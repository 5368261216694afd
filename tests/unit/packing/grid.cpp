// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/chart_sets.hpp>
#include <taut/pack.hpp>

namespace
{

using support::chart_set;
using taut::idx;
using taut::vec2;

taut::packing on_grid(const chart_set& s, const taut::pack_params& params)
{
    return taut::pack(s.uv, s.cells, s.first_cell, s.first_vertex, params);
}

/// In tiles beside each other.
bool holds_on_grid(const chart_set& s, const taut::packing& p, const taut::pack_params& params)
{
    const auto x = p.apply(s.uv, s.first_vertex);
    return taut::certify_packing(x, s.cells, s.first_cell, s.first_vertex, {}, params.aspect)
        .holds(params.padding, p.resolution);
}

double area_on_grid(const chart_set& s)
{
    double area = 0;
    for (const auto& t : s.cells)
        area += taut::impl::orient(s.uv[std::size_t(t[0])], s.uv[std::size_t(t[1])], s.uv[std::size_t(t[2])]).det / 2;
    return area;
}

/// The lower corner of the box of a chart, in texels of its tile.
vec2 low_corner(const chart_set& s, const taut::packing& p, std::size_t c)
{
    vec2 low(1e9);
    for (auto v = std::size_t(s.first_vertex[c]); v < std::size_t(s.first_vertex[c + 1]); ++v)
        low = glm::min(low, p.places[c](s.uv[v]));
    return low * double(p.resolution);
}

} // namespace

TEST_CASE("pack: pages may be wider or higher than a square")
{
    const auto s = support::ragged_charts(30, 60, 20, 1);
    for (const double aspect : {0.25, 0.5, 2.0, 8.0})
    {
        CAPTURE(aspect);
        const taut::pack_params params{.aspect = aspect};
        const auto p = on_grid(s, params);
        CHECK(holds_on_grid(s, p, params));
        CHECK(p.utilization == doctest::Approx(area_on_grid(s) * p.scale * p.scale / aspect));
        CHECK(p.utilization > 0.45);
        CHECK(p.resolution == 1024);
    }
    CHECK_THROWS_AS(on_grid(s, {.aspect = 0.7}), taut::parameter_error);
    CHECK_THROWS_AS(on_grid(s, {.padding = 100, .aspect = 0.125}), taut::parameter_error);
}

TEST_CASE("pack: charts have blocks of texels of their own")
{
    const auto s = support::ragged_charts(40, 60, 20, 2);
    for (const int align : {2, 4, 8})
    {
        CAPTURE(align);
        const taut::pack_params params{.resolution = 512, .padding = 1, .align = align};
        const auto p = on_grid(s, params);
        CHECK(holds_on_grid(s, p, params));
        CHECK(p.utilization > 0.3);
        // Blocks with a point of an edge: none has those of two charts.
        std::map<std::pair<int, int>, std::size_t> owner;
        bool shared = false;
        for (std::size_t c = 0; c < p.places.size(); ++c)
        {
            const vec2 low = low_corner(s, p, c) / double(align);
            CHECK(std::abs(low.x - std::round(low.x)) < 0.01);
            CHECK(std::abs(low.y - std::round(low.y)) < 0.01);
            for (idx t = s.first_cell[c]; t < s.first_cell[c + 1]; ++t)
                for (std::size_t k = 0; k < 3; ++k)
                    for (int n = 0; n <= 8; ++n)
                    {
                        const auto& cell = s.cells[std::size_t(t)];
                        const vec2 a = p.places[c](s.uv[std::size_t(cell[k])]),
                                   b = p.places[c](s.uv[std::size_t(cell[(k + 1) % 3])]);
                        const vec2 x = glm::floor((a + n / 8.0 * (b - a)) * 512.0 / double(align));
                        const auto [at, is_new] = owner.emplace(std::pair(int(x.x), int(x.y)), c);
                        shared = shared || (!is_new && at->second != c);
                    }
        }
        CHECK(!shared);
    }
    CHECK_THROWS_AS(on_grid(s, {.align = 3}), taut::parameter_error);
    CHECK_THROWS_AS(on_grid(s, {.resolution = 64, .align = 16}), taut::parameter_error);
}

TEST_CASE("pack: with texels per unit the scale is given, and tiles or the resolution grow")
{
    const auto s = support::ragged_charts(60, 60, 20, 3);
    const double unit = 1 / std::sqrt(area_on_grid(s)); // 1024 texels a unit of this would fill a tile
    taut::pack_params params{.tiles = 100, .texels_per_unit = 300 * unit};
    const auto one = on_grid(s, params);
    CHECK(one.scale == doctest::Approx(300 * unit / 1024));
    CHECK(one.tiles == 1);
    CHECK(holds_on_grid(s, one, params));
    params.texels_per_unit = 2500 * unit;
    const auto many = on_grid(s, params);
    CHECK(holds_on_grid(s, many, params));
    CHECK(many.scale == doctest::Approx(2500 * unit / 1024));
    CHECK(many.tiles >= 6);
    CHECK(many.tiles <= 14);
    std::set<idx> used;
    for (const auto& place : many.places) used.insert(place.tile);
    CHECK(idx(used.size()) == many.tiles);
    CHECK(many.utilization == doctest::Approx(2500.0 * 2500 / 1024 / 1024 / many.tiles));

    params.tiles = 1;
    params.max_resolution = 8192;
    const auto grown = on_grid(s, params);
    CHECK(grown.resolution == 4096);
    CHECK(grown.scale == doctest::Approx(2500 * unit / 4096));
    CHECK(holds_on_grid(s, grown, params));
    params.max_resolution = 2048;
    CHECK_THROWS_WITH_AS(on_grid(s, params), doctest::Contains("do not fit"), taut::packing_error);
    params.texels_per_unit = 0;
    CHECK_THROWS_AS(on_grid(s, params), taut::parameter_error);
}

TEST_CASE("pack: groups of charts are in their tiles")
{
    const auto s = support::ragged_charts(30, 60, 20, 4);
    taut::pack_params params{.tiles = 3};
    for (idx c = 0; c < s.charts(); ++c) params.groups.push_back(c % 7 == 0 ? 2 : c % 2);
    const auto p = on_grid(s, params);
    CHECK(holds_on_grid(s, p, params));
    for (std::size_t c = 0; c < p.places.size(); ++c) CHECK(p.places[c].tile == params.groups[c]);
    params.groups[3] = 3;
    CHECK_THROWS_AS(on_grid(s, params), taut::parameter_error);
}

TEST_CASE("pack: on a grid, too, the same input gives the same layout, and walls are kept")
{
    const auto s = support::ragged_charts(50, 60, 20, 5);
    taut::pack_params params{.align = 4};
    for (const auto& [a, b] : {std::pair(vec2(0.1, 0.1), vec2(0.5, 0.1)), std::pair(vec2(0.5, 0.1), vec2(0.5, 0.4)),
                               std::pair(vec2(0.5, 0.4), vec2(0.1, 0.4)), std::pair(vec2(0.1, 0.4), vec2(0.1, 0.1))})
        params.walls.push_back({0, {a, b}});
    const auto p = on_grid(s, params), q = on_grid(s, params);
    CHECK(holds_on_grid(s, p, params));
    for (std::size_t c = 0; c < p.places.size(); ++c)
    {
        CHECK(p.places[c].shift == q.places[c].shift);
        for (auto v = std::size_t(s.first_vertex[c]); v < std::size_t(s.first_vertex[c + 1]); ++v)
        {
            const vec2 x = p.places[c](s.uv[v]);
            CHECK_FALSE((x.x > 0.099 && x.x < 0.501 && x.y > 0.099 && x.y < 0.401));
        }
    }
}
