// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include <support/chart_sets.hpp>
#include <taut/pack.hpp>

namespace
{

taut::packing_certificate certificate_of(const support::chart_set& s)
{
    return taut::certify_packing(s.uv, s.cells, s.first_cell, s.first_vertex);
}

/// A square chart with this corner and side.
void add_box(support::chart_set& s, taut::vec2 low, double side)
{
    s.add(
        1, [](taut::vec2) { return true; }, [&](taut::vec2 p) { return low + side / 2 * (p + 1.0); });
}

} // namespace

TEST_CASE("packing certificate: says how near charts come to each other and to the border, and which ones")
{
    support::chart_set s;
    add_box(s, {0.125, 0.25}, 0.25);
    add_box(s, {0.5, 0.25}, 0.25); // 1/8 to the right
    add_box(s, {0.8125, 0.5625}, 0.125);
    const auto c = certificate_of(s);
    CHECK(c.overlaps.pairs == 0);
    CHECK(c.border == 0.0625);
    CHECK(c.outermost == 2);
    CHECK(c.gap == doctest::Approx(std::sqrt(2) * 0.0625)); // corner to corner
    CHECK((c.nearest == std::array<taut::idx, 2>{1, 2}));
    CHECK(c.holds(4, 64));
    CHECK_FALSE(c.holds(5, 64));
}

TEST_CASE("packing certificate: does not hold for charts that overlap, leave their tile, or are nested")
{
    support::chart_set s;
    add_box(s, {0.1, 0.1}, 0.5);
    add_box(s, {0.2, 0.2}, 0.1); // borders are far from each other
    CHECK(certificate_of(s).gap > 0.09);
    CHECK_FALSE(certificate_of(s).holds(0, 1024));
    CHECK(certificate_of(s).overlaps.pairs == 1);
    add_box(s, {0.5, 0.5}, 0.2); // crosses the first
    CHECK(certificate_of(s).overlaps.pairs == 2);
    CHECK(certificate_of(s).gap == 0);
    add_box(s, {0.7, 0.1}, 0.1); // touches none
    add_box(s, {0.8, 0.1}, 0.1); // touches that
    CHECK(certificate_of(s).overlaps.pairs == 2);
    support::chart_set out;
    add_box(out, {0.4, 0.6}, 0.5);
    CHECK(certificate_of(out).border == doctest::Approx(-0.1));
    CHECK_FALSE(certificate_of(out).holds(0, 1024));
    CHECK(certificate_of(out).gap == std::numeric_limits<double>::infinity());
}

TEST_CASE("packing certificate: distances of pinned charts to each other and to the border do not count")
{
    support::chart_set s;
    add_box(s, {0, 0}, 0.25);
    add_box(s, {0.25, 0}, 0.25); // touches both
    add_box(s, {0.5625, 0.0625}, 0.25);
    const std::vector<char> pinned{1, 1, 0};
    const auto c = taut::certify_packing(s.uv, s.cells, s.first_cell, s.first_vertex, pinned);
    CHECK(c.border == 0.0625);
    CHECK(c.gap == 0.0625);
    CHECK((c.nearest == std::array<taut::idx, 2>{1, 2}));
    CHECK(c.holds(4, 64));
    CHECK_FALSE(certificate_of(s).holds(4, 64));
}

TEST_CASE("packing certificate: each tile is a square of its own")
{
    support::chart_set s;
    for (const taut::vec2 tile : {taut::vec2(0, 0), taut::vec2(3, 0), taut::vec2(9, 2)}) add_box(s, tile + 0.25, 0.5);
    CHECK(certificate_of(s).border == 0.25);
    CHECK(certificate_of(s).holds(0.25, 1));
}

TEST_CASE("packing certificate: the gap is that of the nearest points, by all pairs")
{
    std::mt19937 random(11);
    const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
    for (int n = 0; n < 30; ++n)
    {
        support::chart_set s;
        for (int c = 0; c < 8; ++c)
        {
            const double turn = 6 * uniform(), size = 0.02 + 0.06 * uniform();
            const taut::vec2 axis(std::cos(turn), std::sin(turn)), shift(uniform(), uniform());
            s.add(
                3, [](taut::vec2 p) { return p.x < 0.4 || p.y < 0.4; },
                [&](taut::vec2 p)
                { return size * taut::vec2(axis.x * p.x - axis.y * p.y, axis.y * p.x + axis.x * p.y) + shift; });
        }
        // Borders by many points.
        const auto o = taut::impl::find_outlines(s.uv, s.cells, s.first_cell, s.first_vertex);
        std::vector<std::pair<taut::vec2, int>> points;
        for (int c = 0; c < 8; ++c)
            for (auto e = o.first[static_cast<std::size_t>(c)]; e < o.first[static_cast<std::size_t>(c) + 1]; ++e)
                for (int k = 0; k < 10; ++k)
                {
                    const auto& [a, b] = o.edges[static_cast<std::size_t>(e)];
                    points.emplace_back(
                        glm::mix(s.uv[static_cast<std::size_t>(a)], s.uv[static_cast<std::size_t>(b)], k / 10.0), c);
                }
        double least = 1;
        for (const auto& [p, c] : points)
            for (const auto& [q, d] : points)
                if (c < d) least = std::min(least, glm::length(p - q));
        const double gap = certificate_of(s).gap;
        CHECK(gap <= least);
        CHECK(gap >= least - 0.012); // a tenth of the longest edge on both
    }
}
