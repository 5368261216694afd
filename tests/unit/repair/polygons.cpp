// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>
#include <taut/repair.hpp>

namespace
{

using namespace taut;

/// Vertices that two triangles of a surface have in common.
std::size_t common(const mesh<triangle>& m, std::size_t a, std::size_t b)
{
    const auto &s = m.cells()[a], &t = m.cells()[b];
    return static_cast<std::size_t>(
        std::count_if(s.begin(), s.end(), [&](taut::idx v) { return std::find(t.begin(), t.end(), v) != t.end(); }));
}

} // namespace

TEST_CASE("repair: where edges are parted, polygons stay whole")
{
    // Two quads with one diagonal, 0-1: the flattest pairs would be halves of both.
    const std::vector<vec3> points = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0.1}, {0.5, -1, 1}, {0.5, -1, 0}, {0.5, 1, 1}};
    const std::vector<std::array<taut::idx, 3>> cells = {{0, 1, 2}, {1, 0, 3}, {1, 0, 4}, {0, 1, 5}};
    const std::vector<taut::idx> polygons = {0, 0, 1, 1};
    const auto repaired = repair_surface(points, cells, {.polygons = polygons});
    REQUIRE(repaired.cell_origins.size() == 4);
    CHECK(common(repaired.surface, 0, 1) == 2);
    CHECK(common(repaired.surface, 2, 3) == 2);
    CHECK(common(repaired.surface, 0, 2) == 0);
    CHECK(common(repair_surface(points, cells).surface, 0, 1) == 0);
}

TEST_CASE("repair: a one-sided band of quads is cut between quads")
{
    for (const int n : {5, 8, 13})
        for (int diagonals = 0; diagonals < 4; ++diagonals)
        {
            std::vector<vec3> points;
            for (int k = 0; k < n; ++k)
                for (const double s : {-0.4, 0.4})
                {
                    const double a = 2 * std::numbers::pi * k / n;
                    const double r = 1 + s * std::cos(a / 2);
                    points.emplace_back(r * std::cos(a), r * std::sin(a), s * std::sin(a / 2));
                }
            std::vector<std::array<taut::idx, 3>> cells;
            std::vector<taut::idx> polygons;
            for (taut::idx k = 0; k < n; ++k)
            {
                const bool last = k + 1 == n;
                const taut::idx a = 2 * k, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
                if ((k >> (diagonals % 2)) % 2 == diagonals / 2)
                    cells.insert(cells.end(), {{a, c, d}, {a, d, b}});
                else
                    cells.insert(cells.end(), {{a, c, b}, {b, c, d}});
                polygons.insert(polygons.end(), 2, k);
            }
            const auto repaired = repair_surface(points, cells, {.polygons = polygons});
            CHECK(check(repaired.surface, {.connected = false, .open = false, .one_boundary = false}).empty());
            for (std::size_t k = 0; k < cells.size(); k += 2) CHECK(common(repaired.surface, k, k + 1) == 2);
        }
}
