// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include <support/chart_sets.hpp>
#include <taut/impl/charts/packing/pack.hpp>
#include <taut/pack.hpp>

namespace
{

using support::chart_set;
using taut::idx;
using taut::vec2;

taut::packing packed(const chart_set& s, const taut::pack_params& params = {}, const taut::run_limits& limits = {})
{
    return taut::pack(s.uv, s.cells, s.first_cell, s.first_vertex, params, limits);
}

/// Certifies what files get: coordinates as floats.
taut::packing_certificate as_floats(const chart_set& s, const taut::packing& p)
{
    auto x = p.apply(s.uv, s.first_vertex);
    for (vec2& q : x) q = {static_cast<float>(q.x), static_cast<float>(q.y)};
    return taut::certify_packing(x, s.cells, s.first_cell, s.first_vertex);
}

bool holds(const chart_set& s, const taut::packing& p, const taut::pack_params& params = {})
{
    return as_floats(s, p).holds(params.padding, params.resolution);
}

chart_set squares(int count, double side = 1)
{
    chart_set s;
    for (int c = 0; c < count; ++c) s.add_rectangle(side, side, 0.3 * c);
    return s;
}

double area_of(const chart_set& s, std::span<const vec2> x)
{
    double area = 0;
    for (const auto& [a, b, c] : s.cells)
        area += taut::impl::orient(x[static_cast<std::size_t>(a)], x[static_cast<std::size_t>(b)],
                                   x[static_cast<std::size_t>(c)])
                    .det /
                2;
    return area;
}

} // namespace

TEST_CASE("pack: one square fills its tile up to the padding, whichever way it lies")
{
    for (const double angle : {0.0, 0.5, 2.0})
    {
        chart_set s;
        s.add_rectangle(3, 3, angle);
        const auto p = packed(s);
        CHECK(holds(s, p));
        CHECK(p.scale * 3 == doctest::Approx(1 - 4.0 / 1024).epsilon(0.002));
        CHECK(p.utilization == doctest::Approx(area_of(s, p.apply(s.uv, s.first_vertex))));
    }
}

TEST_CASE("pack: nothing is mirrored, all keep one scale, and places say so")
{
    const auto s = support::ragged_charts(12, 60, 20, 1);
    const auto p = packed(s);
    CHECK(holds(s, p));
    REQUIRE(p.places.size() == 12);
    for (const auto& place : p.places)
    {
        CHECK(place.scale == p.scale);
        CHECK(place.cosine * place.cosine + place.sine * place.sine == doctest::Approx(1));
        CHECK(place.tile == 0);
    }
    CHECK(area_of(s, p.apply(s.uv, s.first_vertex)) == doctest::Approx(p.utilization));
}

TEST_CASE("pack: squares of one size fill nine tenths")
{
    for (const int n : {2, 3, 5, 10})
    {
        const auto s = squares(n * n);
        taut::pack_params params;
        params.padding = 0;
        const auto p = packed(s, params);
        CAPTURE(n);
        CHECK(holds(s, p, params));
        CHECK(p.utilization >= 0.9);
    }
}

TEST_CASE("pack: ragged charts of mixed sizes use most of the square")
{
    for (const int n : {30, 150})
    {
        const auto s = support::ragged_charts(n, 100, 20, 7);
        const auto p = packed(s);
        CAPTURE(n);
        CHECK(holds(s, p));
        CHECK(p.utilization > 0.63);
    }
}

TEST_CASE("pack: a thousand charts keep their padding")
{
    const auto s = support::ragged_charts(1000, 16, 50, 2);
    taut::pack_params params;
    params.resolution = 4096;
    const auto p = packed(s, params);
    CHECK(holds(s, p, params));
    CHECK(p.utilization > 0.6);
}

TEST_CASE("pack: small charts are laid in the hole of a large one")
{
    chart_set s;
    s.add(
        16, [](vec2 p) { return std::max(std::abs(p.x), std::abs(p.y)) > 0.75; }, [](vec2 p) { return 10.0 * p; });
    for (int c = 0; c < 4; ++c) s.add_rectangle(6, 6, 0.2);
    const auto p = packed(s);
    CHECK(holds(s, p));
    CHECK(p.scale * 20 == doctest::Approx(1 - 4.0 / 1024).epsilon(0.01)); // the frame has the tile to itself
}

TEST_CASE("pack: padding and resolution are kept")
{
    const auto s = support::ragged_charts(8, 40, 10, 3);
    for (const int resolution : {64, 1024, 8192})
        for (const double padding : {0.0, 1.5, 16.0})
        {
            if (padding > 10 && resolution < 100) continue; // eight charts leave no room for that
            taut::pack_params params;
            params.resolution = resolution;
            params.padding = padding;
            const auto p = packed(s, params);
            CAPTURE(resolution);
            CAPTURE(padding);
            CHECK(holds(s, p, params));
        }
}

TEST_CASE("pack: lengths may be of any unit, and charts anywhere")
{
    const auto s = support::ragged_charts(10, 40, 10, 4);
    const auto use = packed(s).utilization;
    for (const double unit : {1e-150, 1e-9, 1e9, 1e150})
    {
        auto scaled = s;
        for (vec2& p : scaled.uv) p *= unit;
        const auto p = packed(scaled);
        CAPTURE(unit);
        CHECK(holds(scaled, p));
        CHECK(p.utilization == doctest::Approx(use).epsilon(0.02));
    }
    auto far = s;
    for (vec2& p : far.uv) p += vec2(1e9, -3e9);
    CHECK(holds(far, packed(far)));
}

TEST_CASE("pack: a long sliver lies along the diagonal")
{
    chart_set s;
    s.add_rectangle(1000, 1);
    const auto p = packed(s);
    CHECK(holds(s, p));
    CHECK(p.scale * 1000 > 1.38);
    taut::pack_params params;
    params.rotate = false;
    CHECK(packed(s, params).scale * 1000 == doctest::Approx(1 - 4.0 / 1024).epsilon(0.01));
}

TEST_CASE("pack: charts that may not be turned are not")
{
    const auto s = support::ragged_charts(15, 60, 20, 5);
    taut::pack_params params;
    params.rotate = false;
    const auto p = packed(s, params);
    CHECK(holds(s, p));
    for (const auto& place : p.places)
    {
        CHECK(place.cosine == 1);
        CHECK(place.sine == 0);
    }
}

TEST_CASE("pack: several tiles hold larger charts, and each is used")
{
    const auto s = support::ragged_charts(60, 40, 5, 6);
    const double one = packed(s).scale;
    taut::pack_params params;
    params.tiles = 4;
    const auto p = packed(s, params);
    CHECK(holds(s, p));
    CHECK(p.scale > 1.8 * one);
    std::array<int, 4> charts{};
    for (const auto& place : p.places) ++charts.at(static_cast<std::size_t>(place.tile));
    CHECK(*std::min_element(charts.begin(), charts.end()) > 0);
}

TEST_CASE("pack: tiles that no chart can be in change nothing, and cost nothing")
{
    for (const int count : {1, 2, 3, 17})
    {
        const auto s = support::ragged_charts(count, 30, 2, 9);
        taut::pack_params params;
        params.tiles = count;
        const auto p = packed(s, params);
        CHECK(holds(s, p));
        params.tiles = 1000;
        const auto q = packed(s, params);
        CHECK(p.scale == q.scale);
        CHECK(p.layouts == q.layouts);
        for (std::size_t c = 0; c < p.places.size(); ++c)
        {
            CHECK(p.places[c].tile == q.places[c].tile);
            CHECK(p.places[c].shift == q.places[c].shift);
        }
    }
    // Where each chart has a tile of its own, the largest one fills it as if it were alone.
    chart_set s;
    s.add_rectangle(1, 1);
    s.add_rectangle(0.3, 0.2);
    taut::pack_params params;
    params.tiles = 50;
    CHECK(packed(s, params).scale > 0.98 * packed(squares(1)).scale);
}

TEST_CASE("pack: a density gives a chart more texels")
{
    const auto s = squares(5);
    taut::pack_params params;
    params.densities = {2, 1, 1, 1, 0.5};
    const auto p = packed(s, params);
    CHECK(holds(s, p));
    CHECK(p.places[0].scale == 2 * p.scale);
    CHECK(p.places[4].scale == 0.5 * p.scale);
    params.densities = {1, 2};
    CHECK_THROWS_AS(packed(s, params), taut::parameter_error);
    params.densities = {1, 1, 1, 1, 0};
    CHECK_THROWS_AS(packed(s, params), taut::parameter_error);
}

TEST_CASE("pack: the same charts are packed the same way")
{
    const auto s = support::ragged_charts(40, 60, 20, 8);
    const auto x = packed(s).apply(s.uv, s.first_vertex);
    CHECK(packed(s).apply(s.uv, s.first_vertex) == x);
}

TEST_CASE("pack: ended at once, there still is a layout, and it holds")
{
    const auto s = support::ragged_charts(100, 40, 20, 9);
    const auto limited = packed(s, {}, {.time_limit = std::chrono::nanoseconds(1)});
    CHECK_FALSE(limited.complete);
    CHECK(holds(s, limited));
    int asked = 0;
    const auto ended = packed(s, {}, {.observer = [&](const taut::progress&) { return ++asked < 3; }});
    CHECK(asked == 3);
    CHECK_FALSE(ended.complete);
    CHECK(holds(s, ended));
    CHECK(packed(s).complete);
    CHECK(packed(s).scale > ended.scale);
}

TEST_CASE("pack: charts without area among others, folded and clockwise ones have their place, too")
{
    chart_set s = squares(3);
    s.add(
        2, [](vec2) { return true; }, [](vec2 p) { return vec2(p.x, 0); }); // a line
    s.add(
        2, [](vec2) { return true; }, [](vec2) { return vec2(7, 7); }); // a point
    s.add(
        2, [](vec2) { return true; }, [](vec2 p) { return vec2(p.y, p.x); }); // clockwise
    s.add(
        4, [](vec2) { return true; }, [](vec2 p) { return vec2(std::abs(p.x), p.y); }); // folded
    const auto p = packed(s);
    CHECK(holds(s, p));
    CHECK(p.utilization > 0.4);
}

TEST_CASE("pack: refuses what has no area or no room, and takes nothing for nothing")
{
    chart_set s;
    CHECK(packed(s).places.empty());
    s.add(
        1, [](vec2) { return true; }, [](vec2 p) { return vec2(p.x, 0); });
    const auto fault_of = [](const chart_set& charts, const taut::pack_params& params)
    {
        try
        {
            packed(charts, params);
        }
        catch (const taut::packing_error& e)
        {
            return e.fault();
        }
        return taut::packing_error::out_of_range;
    };
    CHECK(fault_of(s, {}) == taut::packing_error::no_area);
    taut::pack_params params;
    params.resolution = 64;
    params.padding = 16;
    CHECK(fault_of(squares(9), params) == taut::packing_error::no_room);
    params.tiles = 9;
    CHECK(holds(squares(9), packed(squares(9), params), params));
    params.padding = 32;
    CHECK_THROWS_AS(packed(squares(9), params), taut::parameter_error);
}

TEST_CASE("pack: charts keep away from walls, and fill what these leave")
{
    const auto add_wall = [](taut::pack_params& params, chart_set& s, idx tile, vec2 low, vec2 high)
    {
        const std::array<vec2, 4> corners{low, vec2(high.x, low.y), high, vec2(low.x, high.y)};
        for (std::size_t k = 0; k < 4; ++k) params.walls.push_back({tile, {corners[k], corners[(k + 1) % 4]}});
        const auto first = static_cast<idx>(s.uv.size());
        for (const vec2& x : corners) s.uv.push_back(x + vec2(tile, 0));
        s.cells.push_back({first, first + 1, first + 2});
        s.cells.push_back({first, first + 2, first + 3});
        s.first_cell.push_back(static_cast<idx>(s.cells.size()));
        s.first_vertex.push_back(static_cast<idx>(s.uv.size()));
    };
    for (const int tiles : {1, 2})
        for (const int count : {1, 40})
        {
            taut::pack_params params;
            params.tiles = tiles;
            chart_set walls;
            add_wall(params, walls, 0, {0, 0}, {1, 0.4});
            add_wall(params, walls, tiles - 1, {0.3, 0.5}, {0.4, 1});
            const auto s = squares(count);
            const auto p = packed(s, params);
            auto all = s;
            all.uv = p.apply(s.uv, s.first_vertex);
            for (const auto& cell : walls.cells)
            {
                auto t = cell;
                for (idx& v : t) v += static_cast<idx>(s.uv.size());
                all.cells.push_back(t);
            }
            all.uv.insert(all.uv.end(), walls.uv.begin(), walls.uv.end());
            for (std::size_t k = 1; k < walls.first_cell.size(); ++k)
            {
                all.first_cell.push_back(s.first_cell.back() + walls.first_cell[k]);
                all.first_vertex.push_back(s.first_vertex.back() + walls.first_vertex[k]);
            }
            std::vector<char> pinned(static_cast<std::size_t>(all.charts()), 0);
            pinned[pinned.size() - 1] = pinned[pinned.size() - 2] = 1;
            const auto c = taut::certify_packing(all.uv, all.cells, all.first_cell, all.first_vertex, pinned);
            CHECK(c.holds(params.padding, params.resolution));
            if (count == 40) CHECK(p.utilization * tiles > 0.25 + (tiles - 1) * 0.3);
        }
    // A run that has no time has a layout, too; what is full has none.
    taut::pack_params params;
    const taut::run_limits none{.time_limit = std::chrono::nanoseconds(1)};
    chart_set walls;
    add_wall(params, walls, 0, {0.25, 0.25}, {0.5, 0.5});
    const auto p = packed(squares(5), params, none);
    CHECK(!p.complete);
    CHECK(p.scale > 0);
    add_wall(params, walls, 0, {0, 0}, {1, 1});
    CHECK_THROWS_AS(packed(squares(5), params, none), taut::packing_error);
}

TEST_CASE("pack: two arcs are nested at directions that are no sixteenth of a circle")
{
    std::vector<vec2> uv;
    std::vector<std::array<taut::idx, 3>> cells;
    std::vector<taut::idx> first_cell{0}, first_vertex{0};
    constexpr taut::idx along = 60;
    for (const double angle : {1.6, 1.7})
    {
        const auto base = static_cast<taut::idx>(uv.size());
        for (taut::idx i = 0; i <= along; ++i)
            for (const double r : {2, 3})
            {
                const double a = angle * i / along;
                uv.emplace_back(r * std::cos(a), r * std::sin(a));
            }
        for (taut::idx i = base; i < base + 2 * along; i += 2)
        {
            cells.push_back({i, i + 1, i + 3});
            cells.push_back({i, i + 3, i + 2});
        }
        first_cell.push_back(static_cast<taut::idx>(cells.size()));
        first_vertex.push_back(static_cast<taut::idx>(uv.size()));
    }
    const auto packed = taut::pack(uv, cells, first_cell, first_vertex);
    CHECK(packed.utilization > 0.55); // 0.52 in sixteen directions
}

TEST_CASE("pack: no better layout is looked for than is enough")
{
    const chart_set s = support::ragged_charts(12, 100, 20, 7);
    const auto outlines = taut::impl::find_outlines(s.uv, s.cells, s.first_cell, s.first_vertex);
    const auto to = [&](double enough)
    { return taut::impl::pack_outlined(s.uv, outlines, {}, {}, taut::impl::packing_effort::full, enough); };
    const auto all = to(2);
    const auto some = to(0.9 * all.utilization);
    CHECK(some.utilization >= 0.9 * all.utilization);
    CHECK(some.layouts < all.layouts / 4);
    CHECK(to(1.001 * all.utilization).utilization == all.utilization);
}
