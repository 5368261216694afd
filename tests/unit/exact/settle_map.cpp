// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <taut/impl/charts/packing/settle_map.hpp>
#include <taut/impl/core/core/single.hpp>
#include <taut/impl/core/exact/convex_polygons.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using triples = std::vector<std::array<taut::idx, 3>>;

vec2 single(vec2 p)
{
    return {in_single(p.x), in_single(p.y)};
}

/// Two rows of points and the triangles between them.
triples strip(taut::idx n)
{
    triples cells;
    for (taut::idx k = 0; k + 1 < n; ++k)
    {
        cells.push_back({2 * k, 2 * k + 2, 2 * k + 1});
        cells.push_back({2 * k + 1, 2 * k + 2, 2 * k + 3});
    }
    return cells;
}

map_faults settle(const triples& cells, std::vector<vec2>& x, const settling& how, const triples& corners = {})
{
    const auto before = x;
    const auto faults = settle_piece(cells, corners, 0, static_cast<taut::idx>(x.size()), x, how);
    for (std::size_t v = 0; v < x.size(); ++v) CHECK(glm::length(x[v] - before[v]) <= how.reach);
    for (const vec2& p : x)
        if (how.stored != nullptr) CHECK(how.stored(p) == p);
    return faults;
}

} // namespace

TEST_CASE("settle: needles that single precision turns over are positive afterwards, all that moved by next to nothing")
{
    for (const double height : {1e-7, 1e-8, 1e-9, 1e-12, 1e-15})
        for (int turn = 0; turn < 12; ++turn)
        {
            // Three points on a line but for the height, with triangles around.
            const double angle = 0.5 * turn;
            const vec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
            const auto at = [&](double s, double t) { return vec2(0.5) + 0.3 * s * along + 0.3 * t * across; };
            std::vector<vec2> x = {at(-1, 0), at(1, 0), at(0.1, height), at(0, -1), at(0, 1)};
            const triples cells = {{0, 1, 2}, {0, 3, 1}, {0, 2, 4}, {1, 4, 2}};
            CHECK(settle(cells, x, {.stored = single, .reach = 1e-6}).valid());
        }
}

TEST_CASE("settle: a stack of needles gets room")
{
    for (const double height : {1e-8, 1e-9, 1e-11})
        for (int turn = 0; turn < 8; ++turn)
        {
            const double angle = std::numbers::pi / 16 * turn;
            const vec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
            std::vector<vec2> x;
            for (int k = 0; k < 6; ++k)
                for (int j = 0; j < 2; ++j) x.push_back(vec2(0.4, 0.98) + 0.3 * (1 - j) * along + height * k * across);
            CHECK(settle(strip(6), x, {.stored = single, .reach = 1e-6}).valid());
        }
}

TEST_CASE("settle: a chart that is smaller than the steps of single precision is spread over some of them")
{
    std::vector<vec2> x;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 2; ++j) x.push_back(vec2(0.7, 0.3) + 1e-11 * vec2(k, j));
    CHECK(settle(strip(4), x, {.stored = single, .reach = 1e-6}).valid());
}

TEST_CASE("settle: borders that nearly touch are parted")
{
    // A ring of 60 quads whose ends are 1e-9 apart.
    for (const double gap : {1e-7, 1e-8, 1e-9, 1e-12})
    {
        std::vector<vec2> x;
        constexpr taut::idx n = 61;
        for (taut::idx k = 0; k < n; ++k)
        {
            const double angle = (2 * std::numbers::pi - gap) * k / (n - 1);
            for (const double r : {0.4, 0.3}) x.push_back(vec2(0.5) + r * vec2(std::cos(angle), std::sin(angle)));
        }
        triples cells;
        for (const auto& t : strip(n)) cells.push_back(t);
        CHECK(settle(cells, x, {.stored = single, .reach = 1e-6}).valid());
    }
}

TEST_CASE("settle: corners of convex polygons turn left afterwards, held vertices stay")
{
    // A grid of quads with some vertices moved so far that quads are concave but no triangle is turned over.
    constexpr int n = 8;
    std::vector<vec3> points;
    std::vector<vec2> x;
    std::mt19937 lot(3);
    std::uniform_real_distribution<double> any(-0.45, 0.45);
    for (int k = 0; k < n * n; ++k)
    {
        const vec2 p(k % n, k / n);
        points.push_back({p.x, p.y, 0});
        x.push_back(p);
    }
    triples cells;
    std::vector<taut::idx> polygon;
    for (int j = 0; j + 1 < n; ++j)
        for (int i = 0; i + 1 < n; ++i)
        {
            const taut::idx a = j * n + i;
            cells.push_back({a, a + 1, a + n + 1});
            cells.push_back({a, a + n + 1, a + n});
            polygon.insert(polygon.end(), 2, static_cast<taut::idx>(cells.size()) - 2);
        }
    for (int k = 0; k < 80; ++k)
    {
        const auto v = lot() % x.size();
        const vec2 before = x[v];
        x[v] += 2.0 * vec2(any(lot), any(lot));
        for (const auto& t : cells)
            if (orient2d(x[std::size_t(t[0])], x[std::size_t(t[1])], x[std::size_t(t[2])]) <= 0) x[v] = before;
    }
    const auto polygons = find_convex_polygons(cells, polygon, points);
    CHECK(polygons.size() == (n - 1) * (n - 1));
    const auto concave = find_concave(polygons, x);
    REQUIRE(concave.size() > 3);
    std::vector<char> held(x.size(), 0);
    held[9] = held[20] = 1;
    const auto before = x;
    const auto faults = settle(cells, x, {.held = held}, polygons.corners);
    CHECK(faults.valid());
    CHECK(x[9] == before[9]);
    CHECK(x[20] == before[20]);
    CHECK(2 * find_concave(polygons, x).size() < concave.size());
}

TEST_CASE("convex polygons: those that are convex in space, whatever their triangles")
{
    const std::vector<vec3> points = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0.1}, {0, 2, 0}, {1, 1, 0}, {1, -1e-9, 0}};
    const auto of = [&](const triples& cells, const std::vector<taut::idx>& polygon)
    { return find_convex_polygons(cells, polygon, points).size(); };
    CHECK(of({{0, 1, 2}, {0, 2, 3}}, {0, 0}) == 1);
    CHECK(of({{0, 1, 2}, {0, 2, 3}}, {0, 1}) == 0);
    CHECK(of({{1, 2, 4}, {2, 3, 4}}, {1, 1}) == 0);               // concave at 4, straight there
    CHECK(of({{0, 5, 2}, {5, 1, 2}, {0, 2, 3}}, {0, 0, 0}) == 0); // almost straight at 5
    const auto found = find_convex_polygons(triples{{0, 1, 3}, {1, 2, 3}}, std::vector<taut::idx>{0, 0}, points);
    REQUIRE(found.size() == 1);
    CHECK(find_concave(found, std::vector<vec2>{{0, 0}, {2, 0}, {2, 2}, {0, 2}}).empty());
    CHECK(find_concave(found, std::vector<vec2>{{0.9, 0.9}, {2, 0}, {2, 2}, {0, 2}}).empty());
    CHECK(find_concave(found, std::vector<vec2>{{1, 1}, {2, 0}, {2, 2}, {0, 2}}).size() == 1);
    CHECK(find_concave(found, std::vector<vec2>{{0, 0}, {2, 0}, {0.9, 0.9}, {0, 2}}).size() == 1);
}
