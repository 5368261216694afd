// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include <taut/impl/core/untangle/convex_corners.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

/// Polygons on a bumpy sheet, cut into fans, and the polygon of each triangle.
struct sheet
{
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    std::vector<idx> polygon;
    std::vector<idx> border;

    mesh<triangle> surface() const { return {points, cells}; }
    std::vector<vec2> seen_from_above() const { return {points.begin(), points.end()}; }

    void add(const std::vector<idx>& corners)
    {
        const idx label = polygon.empty() ? 0 : polygon.back() + 1;
        for (std::size_t k = 1; k + 1 < corners.size(); ++k)
        {
            cells.push_back({corners[0], corners[k], corners[k + 1]});
            polygon.push_back(label);
        }
    }
};

/// n by n quads.
sheet quads(idx n)
{
    sheet s;
    for (idx y = 0; y <= n; ++y)
        for (idx x = 0; x <= n; ++x)
        {
            if (x == 0 || y == 0 || x == n || y == n) s.border.push_back(static_cast<idx>(s.points.size()));
            s.points.emplace_back(x, y, 0.3 * std::sin(0.7 * x) * std::cos(0.5 * y));
        }
    for (idx y = 0; y < n; ++y)
        for (idx x = 0; x < n; ++x)
        {
            const idx a = y * (n + 1) + x;
            s.add({a, a + 1, a + n + 2, a + n + 1});
        }
    return s;
}

/// Polygons of `corners` corners each within quads, a hole of each of which is filled by triangles to its corners.
sheet round_polygons(idx n, idx corners)
{
    sheet s = quads(n);
    s.cells.clear();
    s.polygon.clear();
    for (idx y = 0; y < n; ++y)
        for (idx x = 0; x < n; ++x)
        {
            const std::array<idx, 4> quad{y * (n + 1) + x, y * (n + 1) + x + 1, (y + 1) * (n + 1) + x + 1,
                                          (y + 1) * (n + 1) + x};
            std::vector<idx> ring;
            for (idx k = 0; k < corners; ++k)
            {
                const double a = 2 * std::numbers::pi * (k + 0.5) / corners - 0.75 * std::numbers::pi;
                ring.push_back(static_cast<idx>(s.points.size()));
                s.points.emplace_back(x + 0.5 + 0.35 * std::cos(a), y + 0.5 + 0.35 * std::sin(a), 0.0);
            }
            s.add(ring);
            for (idx k = 0; k < corners; ++k)
            {
                const auto side = [&](idx i) { return static_cast<std::size_t>(4 * i / corners) % 4; };
                const idx a = ring[static_cast<std::size_t>(k)], b = ring[static_cast<std::size_t>((k + 1) % corners)];
                s.add({b, a, quad[(side(k) + 1) % 4]});
                if (side(k) != side(k + 1 == corners ? 0 : k + 1))
                    s.add({b, quad[(side(k) + 1) % 4], quad[(side(k) + 2) % 4]});
            }
        }
    return s;
}

/// Moves vertices at random, as far as triangles stay positive. fixed: these stay
std::vector<vec2> shaken(const sheet& s, double by, std::span<const idx> fixed = {})
{
    const auto m = s.surface();
    const csr around = vertex_cells(m);
    auto x = s.seen_from_above();
    std::mt19937 lot(7);
    const auto part = [&lot] { return 2.0 * static_cast<double>(lot()) / 4294967295.0 - 1; };
    for (int pass = 0; pass < 4; ++pass)
        for (idx v = 0; v < m.vertex_count(); ++v)
        {
            vec2& p = x[static_cast<std::size_t>(v)];
            const vec2 old = p;
            p += by * vec2(part(), part());
            const auto turns = [&](idx c)
            {
                const auto& t = m.cells()[static_cast<std::size_t>(c)];
                const auto at = [&](std::size_t k) { return x[static_cast<std::size_t>(t[k])]; };
                return orient2d(at(0), at(1), at(2)) <= 0;
            };
            const auto star = around.row(v);
            if (std::find(fixed.begin(), fixed.end(), v) != fixed.end() || std::any_of(star.begin(), star.end(), turns))
                p = old;
        }
    return x;
}

struct outcome_of_mending
{
    std::size_t before = 0, after = 0; // concave polygons
    bool injective = false, held = true;
};

outcome_of_mending mend(const sheet& s, std::vector<vec2> x, const fixed_marks<2>& held = {})
{
    const auto m = s.surface();
    const auto polygons = find_convex_polygons(m.cells(), s.polygon, m.points());
    const auto start = x;
    outcome_of_mending r{.before = find_concave(polygons, x).size()};
    convex_corners(m, s.polygon, polygons, held, [] { return true; }).make_convex(x);
    r.after = find_concave(polygons, x).size();
    r.injective = static_cast<bool>(certify<2>(m.cells(), std::span<const vec2>(x)));
    for (std::size_t v = 0; v < held.size(); ++v)
        for (int k = 0; k < 2; ++k) r.held = r.held && (!held.test(v, k) || x[v][k] == start[v][k]);
    return r;
}

TEST_CASE("convex corners: quads of shaken maps become convex, and maps stay injective")
{
    const auto s = quads(24);
    for (const double by : {0.3, 0.6})
    {
        const auto r = mend(s, shaken(s, by));
        CHECK(r.before > 40);
        CHECK(r.after == 0);
        CHECK(r.injective);
    }
}

TEST_CASE("convex corners: fixed coordinates stay, and what they allow becomes convex")
{
    const auto s = quads(24);
    fixed_marks<2> held(s.points.size());
    for (const idx v : s.border) held[static_cast<std::size_t>(v)] = fixed_marks<2>::every;
    for (std::size_t v = 30; v < held.size(); v += 17) held[v] = v % 2 == 0 ? fixed_marks<2>::every : 1;
    const auto r = mend(s, shaken(s, 0.6, s.border), held);
    CHECK(r.before > 50);
    CHECK(r.after == 0);
    CHECK(r.injective);
    CHECK(r.held);
}

TEST_CASE("convex corners: a corner that fixed vertices turn over stays, others around it do not")
{
    const auto s = quads(8);
    auto x = s.seen_from_above();
    fixed_marks<2> held(s.points.size());
    for (const std::size_t v : {39u, 30u, 31u}) held[v] = fixed_marks<2>::every; // three corners of a quad
    x[30] = {3.6, 3.6};                                                          // the one between the others
    x[42] = {6.4, 4.6};                                                          // of another quad, and free
    const auto r = mend(s, x, held);
    CHECK(r.before == 2);
    CHECK(r.after == 1);
    CHECK(r.injective);
    CHECK(r.held);
}

TEST_CASE("convex corners: polygons of five to twelve corners become convex")
{
    for (const idx corners : {5, 6, 8, 12})
    {
        CAPTURE(corners);
        const auto s = round_polygons(6, corners);
        REQUIRE(certify<2>(s.cells, std::span<const vec2>(s.seen_from_above())));
        const auto r = mend(s, shaken(s, 0.15));
        CHECK(r.before > 5);
        CHECK(r.after == 0);
        CHECK(r.injective);
    }
}

TEST_CASE("convex corners: maps whose polygons are convex do not change")
{
    const auto s = quads(6);
    auto x = s.seen_from_above();
    const auto m = s.surface();
    const auto polygons = find_convex_polygons(m.cells(), s.polygon, m.points());
    CHECK_FALSE(convex_corners(m, s.polygon, polygons, {}, [] { return true; }).make_convex(x));
    CHECK(x == s.seen_from_above());
}

} // namespace
