// SPDX-License-Identifier: MIT
#include <cmath>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <support/chart_sets.hpp>
#include <taut/impl/charts/packing/chart_overlaps.hpp>

namespace
{

using taut::idx;
using taut::vec2;

taut::impl::chart_overlaps overlaps_of(const support::chart_set& s, std::size_t most = 100'000)
{
    return taut::impl::find_chart_overlaps(s.uv, s.cells, s.first_cell, s.first_vertex, most);
}

/// A chart of one grid, moved by `shift`, without its middle if `hollow`.
void add_square(support::chart_set& s, int n, vec2 shift, double half = 1, bool hollow = false)
{
    s.add(
        n, [&](vec2 p) { return !hollow || std::max(std::abs(p.x), std::abs(p.y)) > 0.5; },
        [&](vec2 p) { return half * p + shift; });
}

} // namespace

TEST_CASE("chart overlaps: charts that touch along edges or in corners have none, moved by an ulp they do")
{
    support::chart_set s;
    add_square(s, 3, {0, 0});
    add_square(s, 4, {2, 0}); // shares a side, vertices of which lie on edges
    add_square(s, 3, {2, 2}); // shares a corner with the first one
    CHECK(overlaps_of(s).pairs == 0);
    for (idx v = s.first_vertex[1]; v < s.first_vertex[2]; ++v)
        if (double& x = s.uv[static_cast<std::size_t>(v)].x; x == 1) x = std::nextafter(x, 0.0);
    const auto found = overlaps_of(s);
    CHECK(found.pairs == 1);
    CHECK(found.first == std::array<idx, 2>{0, 1});
}

TEST_CASE("chart overlaps: a chart on itself, within another, across it, and mirrored on it")
{
    for (const vec2 shift : {vec2(0, 0), vec2(0.1, 0.05), vec2(0.5, 0.5), vec2(0, 1)})
    {
        CAPTURE(shift.x);
        for (const double half : {0.25, 1.0, 3.0})
        {
            support::chart_set s;
            add_square(s, 4, {0, 0});
            add_square(s, 4, shift, half);
            CHECK(overlaps_of(s).pairs == 1);
            for (idx v = s.first_vertex[1]; v < s.first_vertex[2]; ++v) s.uv[static_cast<std::size_t>(v)].x *= -1;
            CHECK(overlaps_of(s).pairs == 1);
        }
    }
}

TEST_CASE("chart overlaps: a chart in the hole of another has none, whether or not it fills it")
{
    for (const double half : {0.1, 0.5})
    {
        support::chart_set s;
        add_square(s, 8, {0, 0}, 1, true);
        add_square(s, 2, {0, 0}, half);
        CHECK(overlaps_of(s).pairs == 0);
        add_square(s, 2, {0, 0}, 0.51);
        CHECK(overlaps_of(s).pairs == 2);
    }
}

TEST_CASE("chart overlaps: a corner between the triangles of a corner that it touches is found by the middle ones")
{
    // Three triangles about the origin, the middle one alone reaches what lies below.
    support::chart_set s;
    s.uv = {{0, 0}, {4, 1}, {4, -1}, {-4, -1}, {-4, 1}, {0, 0}, {1, -3}, {2, -9}, {-2, -9}};
    s.cells = {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {5, 8, 7}};
    s.first_cell = {0, 3, 4};
    s.first_vertex = {0, 5, 9};
    CHECK(overlaps_of(s).pairs == 1);
}

TEST_CASE("chart overlaps: a folded chart counts for what it covers")
{
    support::chart_set s;
    s.uv = {{0, 0}, {2, 0}, {2, 2}, {1.9, 0.1}, {0.5, 0.3}, {0.6, 0.3}, {0.6, 0.4}};
    s.cells = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}}; // the second lies on the first, clockwise
    s.first_cell = {0, 2, 3};
    s.first_vertex = {0, 4, 7};
    CHECK(overlaps_of(s).pairs == 1);
}

TEST_CASE("chart overlaps: agree with all pairs of triangles on random charts, many of which touch")
{
    std::mt19937 random(3);
    for (int n = 0; n < 40; ++n)
    {
        support::chart_set s;
        const auto at = [&](int range) { return static_cast<double>(random() % static_cast<unsigned>(range)); };
        for (int c = 0; c < 12; ++c) add_square(s, 2, {at(12), at(12)}, 1 + at(3), false);
        std::size_t expected = 0;
        const auto corners = [&](idx t)
        {
            const auto& c = s.cells[static_cast<std::size_t>(t)];
            const auto x = [&](std::size_t k) { return s.uv[static_cast<std::size_t>(c[k])]; };
            return std::array{x(0), x(1), x(2)};
        };
        for (std::size_t a = 0; a < 12; ++a)
            for (std::size_t b = a + 1; b < 12; ++b)
            {
                bool meet = false;
                for (idx t = s.first_cell[a]; t < s.first_cell[a + 1]; ++t)
                    for (idx o = s.first_cell[b]; o < s.first_cell[b + 1]; ++o)
                        meet = meet || taut::impl::interiors_meet(corners(t), corners(o));
                expected += meet;
            }
        CHECK(overlaps_of(s).pairs == expected);
    }
}

TEST_CASE("chart overlaps: of charts that all lie on each other, as many as were asked for")
{
    support::chart_set s;
    for (int c = 0; c < 300; ++c) add_square(s, 2, {0, 0});
    CHECK(overlaps_of(s).pairs == 300 * 299 / 2);
    const auto some = overlaps_of(s, 100);
    CHECK(some.pairs == 100);
    CHECK_FALSE(some.all);
}

TEST_CASE("chart overlaps: what is no set of charts is refused with its numbers")
{
    support::chart_set s;
    add_square(s, 2, {0, 0});
    add_square(s, 2, {5, 0});
    const auto fault_of = [](const support::chart_set& broken)
    {
        try
        {
            overlaps_of(broken);
        }
        catch (const taut::packing_error& e)
        {
            return std::pair(e.fault(), e.ids());
        }
        return std::pair(taut::packing_error::no_room, std::vector<idx>{-1});
    };
    auto broken = s;
    broken.uv[12].y = std::nan("");
    CHECK(fault_of(broken) == std::pair(taut::packing_error::not_finite, std::vector<idx>{12}));
    broken = s;
    broken.cells[9][1] = 3; // of the first chart
    CHECK(fault_of(broken) == std::pair(taut::packing_error::out_of_range, std::vector<idx>{9}));
    broken = s;
    broken.first_cell = {0, 8, 8, 16};
    broken.first_vertex = {0, 9, 9, 18};
    CHECK(fault_of(broken) == std::pair(taut::packing_error::no_triangle, std::vector<idx>{1}));
}
