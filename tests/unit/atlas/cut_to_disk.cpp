// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

#include <support/chart_checks.hpp>
#include <support/closed_meshes.hpp>
#include <support/meshes.hpp>
#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/charts/atlas/cut_to_disk.hpp>
#include <taut/impl/core/mesh/validate.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

double seam_length(const mesh<triangle>& m, const facet_table& f, std::span<const char> seam)
{
    double length = 0;
    for (std::size_t s = 0; s < seam.size(); ++s)
    {
        const auto [a, b] = side_vertices(m, static_cast<idx>(s));
        if (seam[s] && f.twin[s] > static_cast<idx>(s))
            length += glm::distance(m.points()[static_cast<std::size_t>(a)], m.points()[static_cast<std::size_t>(b)]);
    }
    return length;
}

/// Every component must become one disk. Returns the length of the seams.
double check_disks(const mesh<triangle>& m, idx components = 1)
{
    const auto f = facets(m);
    const auto seam = cut_to_disk(m, f);
    const auto charts = cut_charts(m, f, seam);
    CHECK(cut_to_disk(m) == seam);
    CHECK(cut_charts(m, seam).surface.cells() == charts.surface.cells());
    REQUIRE(charts.charts() == components);
    for (idx k = 0; k < components; ++k)
    {
        const auto faults = check(test::chart(charts, k));
        if (!faults.empty()) FAIL(faults.front().message);
    }
    return seam_length(m, f, seam);
}

} // namespace

TEST_CASE("cut_to_disk: closed surfaces, handles and several boundaries end as one disk")
{
    check_disks(test::ball(8));
    check_disks(test::noisy(test::ball(6), 0.1));
    check_disks(test::octahedron());
    check_disks(
        mesh<triangle>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}));
    check_disks(test::torus(12, false));
    check_disks(test::torus(12, true));
    check_disks(test::annulus(24));
    for (int handles = 1; handles <= 3; ++handles)
    {
        const auto plate = test::pierced_plate(handles, 3);
        check_disks(plate);
        check_disks(test::without(plate, [](idx c) { return c == 3 || c == 40 || c == 77; }));
    }
}

TEST_CASE("cut_to_disk: diagonals of polygons are never cut")
{
    for (const bool hole : {false, true})
    {
        // Sheared, so that the short ways run along diagonals.
        const auto torus =
            test::moved(test::torus(12, hole), [](const vec3& p) { return vec3(p.x + 2 * p.z, p.y, p.z); });
        const auto f = facets(torus);
        std::vector<char> diagonals(f.twin.size(), 0);
        for (std::size_t s = 0; s < diagonals.size(); ++s)
            diagonals[s] = f.twin[s] >= 0 && f.twin[s] / 6 == static_cast<idx>(s) / 6; // quads are pairs of triangles
        const auto seam = cut_to_disk(torus, f, diagonals);
        for (std::size_t s = 0; s < seam.size(); ++s) CHECK(!(seam[s] && diagonals[s]));
        const auto charts = cut_charts(torus, f, seam);
        REQUIRE(charts.charts() == 1);
        CHECK(check(test::chart(charts, 0)).empty());
    }
}

TEST_CASE("cut_to_disk: a disk needs no seam")
{
    CHECK(check_disks(test::bumpy(12)) == 0);
    CHECK(check_disks(test::single_triangle()) == 0);
}

TEST_CASE("cut_to_disk: each component is cut by itself")
{
    check_disks(test::both(test::both(test::ball(4), test::pierced_plate(2, 2)), test::tube(12, 2)), 3);
}

TEST_CASE("cut_to_disk: boundaries are joined by the shortest way")
{
    CHECK(check_disks(test::annulus(24)) == doctest::Approx(1).epsilon(1e-9));
}

TEST_CASE("cut_to_disk: a torus is cut along its shortest loops")
{
    // Radii 3 and 1: once around the tube and once around the hole, where that is narrowest.
    const double shortest = 2 * std::numbers::pi * (1 + 2);
    const double length = check_disks(test::torus(48, false));
    CHECK(length > 0.9 * shortest);
    CHECK(length < 1.2 * shortest);
}

TEST_CASE("cut_to_disk: the seam of a long body runs from end to end")
{
    const auto stick = test::moved(test::ball(10), [](const vec3& p) { return vec3(6 * p.x, p.y, p.z); });
    const auto f = facets(stick);
    const auto seam = cut_to_disk(stick, f);
    double low = 0, high = 0;
    for (std::size_t s = 0; s < seam.size(); ++s)
        if (seam[s])
        {
            const double x = stick.points()[static_cast<std::size_t>(side_vertices(stick, static_cast<idx>(s))[0])].x;
            low = std::min(low, x);
            high = std::max(high, x);
        }
    CHECK(high - low > 11);
}
