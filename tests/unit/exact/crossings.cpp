// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>
#include <random>

#include <doctest/doctest.h>

#include <taut/certify.hpp>
#include <taut/impl/core/exact/crossings.hpp>

namespace
{

using taut::boundary_crossings;
using taut::vec2;
using loops = std::vector<std::vector<taut::idx>>;

std::vector<taut::idx> range(taut::idx first, taut::idx count)
{
    std::vector<taut::idx> r;
    for (taut::idx k = 0; k < count; ++k) r.push_back(first + k);
    return r;
}

} // namespace

TEST_CASE("boundary crossings: simple polygons have none")
{
    CHECK(boundary_crossings(loops{range(0, 4)}, std::vector<vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}) == 0);
    std::vector<vec2> star;
    for (int k = 0; k < 40; ++k)
    {
        const double radius = k % 2 == 0 ? 1.0 : 0.3;
        star.emplace_back(radius * std::cos(k * std::numbers::pi / 20), radius * std::sin(k * std::numbers::pi / 20));
    }
    CHECK(boundary_crossings(loops{range(0, 40)}, star) == 0);
    CHECK(boundary_crossings(loops{}, star) == 0);
}

TEST_CASE("boundary crossings: a bow tie has one, a pentagram five")
{
    CHECK(boundary_crossings(loops{range(0, 4)}, std::vector<vec2>{{0, 0}, {1, 1}, {1, 0}, {0, 1}}) == 1);
    std::vector<vec2> pentagram;
    for (int k = 0; k < 5; ++k)
        pentagram.emplace_back(std::cos(k * 4 * std::numbers::pi / 5), std::sin(k * 4 * std::numbers::pi / 5));
    CHECK(boundary_crossings(loops{range(0, 5)}, pentagram) == 5);
}

TEST_CASE("boundary crossings: touching and overlapping edges count")
{
    // A vertex on an edge that is not its own: the two edges at the vertex touch it.
    CHECK(boundary_crossings(loops{range(0, 5)}, std::vector<vec2>{{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}) == 2);
    // A spike folded back over its own edge, and its tip's next edge touches that edge too.
    CHECK(boundary_crossings(loops{range(0, 4)}, std::vector<vec2>{{0, 0}, {2, 0}, {1, 0}, {0, 1}}) == 2);
    // A flat triangle folds back at both ends; the middle vertex goes straight on.
    CHECK(boundary_crossings(loops{range(0, 3)}, std::vector<vec2>{{0, 0}, {2, 0}, {1, 0}}) == 2);
}

TEST_CASE("boundary crossings: straight vertices are no crossings")
{
    CHECK(boundary_crossings(loops{range(0, 5)}, std::vector<vec2>{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}) == 0);
}

TEST_CASE("boundary crossings: two loops cross each other")
{
    const std::vector<vec2> x{{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}, {3, 1}, {3, 3}, {1, 3}};
    CHECK(boundary_crossings(loops{range(0, 4), range(4, 4)}, x) == 2);
    auto apart = x;
    for (std::size_t k = 4; k < 8; ++k) apart[k] += vec2(5, 0);
    CHECK(boundary_crossings(loops{range(0, 4), range(4, 4)}, apart) == 0);
}

TEST_CASE("boundary crossings: two loops that meet in a corner touch with both edges of each")
{
    std::vector<vec2> x{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {1, 1}, {2, 1}, {2, 2}, {1, 2}};
    for (int turn = 0; turn < 4; ++turn)
    {
        CHECK(boundary_crossings(loops{range(0, 4), range(4, 4)}, x) == 4);
        for (vec2& p : x) p = {-p.y, p.x};
    }
}

TEST_CASE("boundary crossings: agrees with all pairs on random polygons, whichever way they lie")
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int n = 0; n < 40; ++n)
    {
        std::vector<vec2> x(60);
        for (auto& p : x) p = {uniform(random), (n % 2 == 0 ? 1 : 4) * uniform(random)};
        std::size_t expected = 0;
        const auto inside = [](double t) { return t > 0 && t < 1; };
        for (std::size_t i = 0; i < 60; ++i)
            for (std::size_t j = i + 2; j < 60; ++j)
            {
                if (i == 0 && j == 59) continue;
                const vec2 p = x[i];
                const vec2 r = x[i + 1] - p;
                const vec2 q = x[j];
                const vec2 s = x[(j + 1) % 60] - q;
                const double d = r.x * s.y - r.y * s.x; // p + t r = q + u s
                const double t = ((q - p).x * s.y - (q - p).y * s.x) / d;
                const double u = ((q - p).x * r.y - (q - p).y * r.x) / d;
                if (inside(t) && inside(u)) ++expected;
            }
        CHECK(boundary_crossings(loops{range(0, 60)}, x) == expected);
    }
}

TEST_CASE("boundary crossings: agrees with all pairs on many chains that touch, overlap and coincide")
{
    std::mt19937 random(8);
    for (int n = 0; n < 20; ++n)
    {
        // Loops of four on a coarse grid: many edges of all lengths share points and lines.
        std::vector<vec2> x;
        std::vector<std::vector<taut::idx>> all;
        for (int loop = 0; loop < 20; ++loop)
        {
            all.push_back(range(4 * loop, 4));
            for (int k = 0; k < 4; ++k) x.emplace_back(random() % 9, random() % (n % 2 ? 3 : 9));
        }
        const auto edges = taut::impl::edges_of(all);
        std::size_t expected = 0;
        for (std::size_t i = 0; i < edges.size(); ++i)
            for (std::size_t j = i + 1; j < edges.size(); ++j)
                expected += taut::impl::edges_meet(edges[i], edges[j], x);
        CHECK(boundary_crossings(all, x) == expected);
        CHECK(taut::impl::count_boundary_crossings(all, x).pairs == expected);
        CHECK(taut::impl::count_boundary_crossings(all, x).all);
    }
}

TEST_CASE("boundary crossings: charts that all lie on each other are counted up to a limit")
{
    // As many crossings as pairs of edges: 20,000 squares would have 6e9.
    std::vector<vec2> x;
    std::vector<std::vector<taut::idx>> squares;
    for (int k = 0; k < 20'000; ++k)
    {
        squares.push_back(range(4 * k, 4));
        for (const vec2 p : {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)}) x.push_back(p);
    }
    const auto found = taut::impl::count_boundary_crossings(squares, x, 1000);
    CHECK(found.pairs == 1000);
    CHECK_FALSE(found.all);

    // Long edges beside each other, whose boxes all meet, are given up without a crossing.
    x.clear();
    std::vector<std::vector<taut::idx>> strips;
    for (int k = 0; k < 20'000; ++k)
    {
        strips.push_back(range(2 * k, 2));
        x.emplace_back(0.001 * k, 0);
        x.emplace_back(1 + 0.001 * k, 1);
    }
    const auto unknown = taut::impl::count_boundary_crossings(strips, x, 10);
    CHECK_FALSE(unknown.all);
}
