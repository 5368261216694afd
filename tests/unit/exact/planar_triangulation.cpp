// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <support/size.hpp>
#include <taut/impl/core/exact/exact_sum.hpp>
#include <taut/impl/core/exact/refine_triangulation.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

vec2 place(const planar_triangulation& t, idx v)
{
    return t.points()[static_cast<std::size_t>(v)];
}

/// Positive triangles whose areas sum to that of the rectangle, all in exact arithmetic: they cover it once.
void check_cover(const planar_triangulation& t)
{
    impl::exact_sum<2> missing; // twice the area
    const auto add = [&missing](bool negative, const vec2& p, const vec2& q)
    {
        missing.add(negative, {p.x, q.y});
        missing.add(!negative, {p.y, q.x});
    };
    std::size_t flipped = 0, unmatched = 0;
    for (const auto& c : t.cells())
    {
        flipped += orient2d(place(t, c[0]), place(t, c[1]), place(t, c[2])) <= 0;
        for (std::size_t k = 0; k < 3; ++k) add(true, place(t, c[k]), place(t, c[(k + 1) % 3]));
    }
    for (idx k = 0; k < 4; ++k) add(false, place(t, k), place(t, (k + 1) % 4));
    for (idx s = 0; s < 3 * static_cast<idx>(t.cells().size()); ++s)
        unmatched += t.twin(s) != planar_triangulation::none && t.twin(t.twin(s)) != s;
    CHECK(flipped == 0);
    CHECK(unmatched == 0);
    CHECK(missing.sign() == 0);
}

bool has_edge(const planar_triangulation& t, idx a, idx b)
{
    const idx s = t.side_between(a, b);
    return s != planar_triangulation::none && t.is_fixed(s) && t.is_fixed(t.twin(s));
}

/// A wavy ring of points around a centre.
std::vector<idx> add_ring(planar_triangulation& t, int n, const vec2& centre, double radius, double wave, int waves)
{
    std::vector<idx> ring;
    for (int i = 0; i < n; ++i)
    {
        const double a = 2 * std::numbers::pi * i / n, r = radius * (1 + wave * std::sin(waves * a));
        ring.push_back(t.add(centre + r * vec2(std::cos(a), std::sin(a))));
    }
    return ring;
}

/// Of the triangles without a corner of the rectangle.
double smallest_angle(const planar_triangulation& t)
{
    double least = std::numbers::pi;
    for (const auto& c : t.cells())
    {
        const auto on_rim = [](idx v) { return v < 4; };
        if (std::any_of(c.begin(), c.end(), on_rim)) continue;
        for (std::size_t k = 0; k < 3; ++k)
        {
            const vec2 e = place(t, c[(k + 1) % 3]) - place(t, c[k]), f = place(t, c[(k + 2) % 3]) - place(t, c[k]);
            least = std::min(least, std::acos(std::clamp(glm::dot(e, f) / (glm::length(e) * glm::length(f)), -1., 1.)));
        }
    }
    return least;
}

} // namespace

TEST_CASE("planar_triangulation: a wavy polygon with holes keeps all its edges, and triangles cover the rectangle")
{
    planar_triangulation t({-3, -3}, {3, 3});
    std::mt19937 rng(7);
    const auto coordinate = [&rng] { return double(rng()) / 4294967296.0 * 6 - 3; };
    std::vector<std::vector<idx>> rings = {add_ring(t, test::sized(10000, 2000), vec2(0), 1.5, 0.6, 50)};
    rings.push_back(add_ring(t, 60, {0.1, 0.2}, 0.2, 0.5, 3));
    rings.push_back(add_ring(t, 300, {-0.2, -0.2}, 0.15, 0.3, 7));
    for (int i = 0; i < 500; ++i) t.add({coordinate(), coordinate()});
    check_cover(t);
    for (const auto& ring : rings)
        for (std::size_t k = 0; k < ring.size(); ++k) t.fix(ring[k], ring[(k + 1) % ring.size()]);
    check_cover(t);
    std::size_t missing = 0;
    for (const auto& ring : rings)
        for (std::size_t k = 0; k < ring.size(); ++k) missing += !has_edge(t, ring[k], ring[(k + 1) % ring.size()]);
    CHECK(missing == 0);
}

TEST_CASE("planar_triangulation: edges between points by lot cross and are refused, or are there from then on")
{
    planar_triangulation t({0, 0}, {1, 1});
    std::mt19937 rng(3);
    const auto coordinate = [&rng] { return (double(rng()) / 4294967296.0 + 0.1) / 1.2; };
    std::vector<idx> points;
    for (int i = 0; i < 400; ++i) points.push_back(t.add({coordinate(), coordinate()}));
    std::vector<std::array<idx, 2>> made;
    int refused = 0;
    for (int i = 0; i < 300; ++i)
    {
        const idx a = points[rng() % points.size()], b = points[rng() % points.size()];
        if (a == b) continue;
        const bool crosses = std::any_of(made.begin(), made.end(),
                                         [&](const auto& e) {
                                             return impl::edges_meet({a, b}, e, t.points());
                                         });
        if (crosses)
            CHECK_THROWS_AS(t.fix(a, b), parameter_error);
        else
        {
            t.fix(a, b);
            made.push_back({a, b});
        }
        refused += crosses;
    }
    CHECK(made.size() > 20);
    CHECK(refused > 20);
    check_cover(t);
    for (const auto& [a, b] : made) CHECK(has_edge(t, a, b));
}

TEST_CASE("planar_triangulation: an edge through vertices becomes an edge between each two of them")
{
    planar_triangulation t({-1, -1}, {11, 11});
    std::vector<idx> at;
    for (int j = 0; j <= 10; ++j)
        for (int i = 0; i <= 10; ++i) at.push_back(t.add({i, j}));
    CHECK(t.add({3, 4}) == at[4 * 11 + 3]); // a vertex that is there
    t.fix(at[0], at[120]);
    t.fix(at[5 * 11 + 10], at[5 * 11]);
    for (std::size_t i = 0; i < 10; ++i)
    {
        CHECK(has_edge(t, at[12 * i], at[12 * (i + 1)]));
        CHECK(has_edge(t, at[55 + i], at[55 + i + 1]));
    }
    check_cover(t);
    const idx half = t.add({0.5, 0.5}); // on an edge that is fixed
    CHECK(has_edge(t, at[0], half));
    CHECK(has_edge(t, half, at[12]));
    CHECK(t.side_between(at[0], at[12]) == planar_triangulation::none);
    check_cover(t);
}

TEST_CASE("planar_triangulation: points a rounding away from a line are told apart from it")
{
    planar_triangulation t({0, 0}, {1, 1});
    std::vector<idx> points;
    for (int i = 1; i < 60; ++i)
    {
        const double x = i / 60.0;
        points.push_back(t.add({x, i % 3 == 0 ? x : std::nextafter(x, i % 2)}));
    }
    for (std::size_t i = 1; i < points.size(); ++i) t.fix(points[i - 1], points[i]);
    check_cover(t);
}

TEST_CASE("planar_triangulation: what is no rectangle, or lies outside of it, is refused by name")
{
    CHECK_THROWS_AS(planar_triangulation({0, 0}, {1, 0}), parameter_error);
    CHECK_THROWS_AS(planar_triangulation({0, 0}, {std::numeric_limits<double>::quiet_NaN(), 1}), parameter_error);
    planar_triangulation t({0, 0}, {1, 1});
    for (const vec2& p : {vec2(0, 0.5), vec2(0.5, 1), vec2(2, 2), vec2(0.5, std::nan(""))})
        CHECK_THROWS_AS(t.add(p), parameter_error);
    CHECK(t.points().size() == 4);
}

TEST_CASE("refine: chosen triangles lose their small angles, and others stay as they are")
{
    planar_triangulation t({-2, -2}, {2, 2});
    const auto ring = add_ring(t, 90, vec2(0), 1, 0.1, 5);
    for (std::size_t k = 0; k < ring.size(); ++k) t.fix(ring[k], ring[(k + 1) % ring.size()]);
    std::vector<char> outside;
    std::vector<planar_triangulation::triangle_corners> within;
    for (const auto& c : t.cells())
    {
        const vec2 centre = (place(t, c[0]) + place(t, c[1]) + place(t, c[2])) / 3.0;
        const double a = std::atan2(centre.y, centre.x);
        outside.push_back(glm::length(centre) > 1 + 0.1 * std::sin(5 * a));
        if (!outside.back()) within.push_back(c);
    }
    REQUIRE(within.size() == 88);
    CHECK(smallest_angle(t) < 0.03);

    planar_triangulation few = t;
    refine(few, outside, 10);
    CHECK(few.points().size() == t.points().size() + 10);
    refine(t, outside, 100000);
    check_cover(t);
    CHECK(t.points().size() > few.points().size());
    CHECK(t.points().size() < 1000);
    std::vector<planar_triangulation::triangle_corners> still;
    for (std::size_t c = 0; c < outside.size(); ++c)
        if (!outside[c]) still.push_back(t.cells()[c]);
    CHECK(still == within);

    planar_triangulation whole({0, 0}, {4, 3});
    for (int i = 0; i < 40; ++i) whole.add({2 + 0.001 * i * std::cos(i), 1.5 + 0.02 * i * std::sin(i)});
    refine(whole, std::vector<char>(whole.cells().size(), 1), 100000);
    check_cover(whole);
    CHECK(smallest_angle(whole) > 0.2);
}

TEST_CASE("planar triangulation: no point is added on an edge that is fixed, whichever side of its triangle that is")
{
    planar_triangulation t({-1, -1}, {9, 9});
    for (idx j = 0; j < 4; ++j)
        for (idx i = 0; i < 4; ++i) t.add({2 * i + j % 2, 2 * j});
    std::array<int, 3> tried{};
    const auto sides = 3 * static_cast<idx>(t.cells().size());
    for (idx s = 0; s < sides; ++s)
    {
        const auto& corners = t.cells()[static_cast<std::size_t>(s / 3)];
        const idx a = corners[static_cast<std::size_t>((s + 1) % 3)],
                  b = corners[static_cast<std::size_t>((s + 2) % 3)];
        if (t.twin(s) == planar_triangulation::none) continue;
        planar_triangulation fixed = t;
        fixed.fix(a, b);
        const vec2 middle = (place(t, a) + place(t, b)) / 2.0; // exact
        CHECK(fixed.add_from(s / 3, middle) == planar_triangulation::none);
        CHECK(planar_triangulation(t).add_from(s / 3, middle) == static_cast<idx>(t.points().size()));
        ++tried[static_cast<std::size_t>(s % 3)];
    }
    CHECK(std::min({tried[0], tried[1], tried[2]}) > 0);
}
