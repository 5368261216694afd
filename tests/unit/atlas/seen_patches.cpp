// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include <support/chart_checks.hpp>
#include <support/closed_meshes.hpp>
#include <support/meshes.hpp>
#include <taut/certify.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/charts/atlas/crossing_charts.hpp>
#include <taut/impl/charts/atlas/seen_patches.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

/// Lays patches of so many triangles at most, and checks what is promised of them. Returns how many there are.
idx check_patches(const mesh<triangle>& m, std::size_t largest, const std::vector<char>& regions)
{
    const auto f = facets(m);
    const auto laid = impl::lay_as_seen(m, f, regions, {}, largest);
    std::vector<std::size_t> size(laid.energy.size(), 0);
    for (const idx p : laid.patch)
    {
        REQUIRE(p >= 0);
        ++size[static_cast<std::size_t>(p)];
    }
    CHECK(*std::max_element(size.begin(), size.end()) <= largest);
    for (const double e : laid.energy) CHECK((e >= 4 - 1e-9 && e <= 6.25));
    const auto seam = seams_between(f, laid.patch);
    const idx charts = test::check_flattenable(m, f, seam);
    CHECK(charts == static_cast<idx>(laid.energy.size()));
    const auto cut = cut_charts(m, f, seam);
    std::vector<vec2> uv(cut.surface.points().size());
    for (std::size_t i = 0; i < cut.cell_origins.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            uv[static_cast<std::size_t>(cut.surface.cells()[i][k])] =
                laid.uv[static_cast<std::size_t>(cut.cell_origins[i])][k];
    CHECK(bool(certify<2>(cut.surface.cells(), std::span<const vec2>(uv))));
    const auto crossing = impl::crossing_charts(cut, uv);
    CHECK(std::count(crossing.begin(), crossing.end(), char(1)) == 0);
    return charts;
}

idx check_patches(const mesh<triangle>& m, std::size_t largest)
{
    return check_patches(m, largest, std::vector<char>(m.cells().size(), 1));
}

} // namespace

TEST_CASE("seen_patches: disks without flips, of any surface")
{
    for (const auto& m : {test::ball(10), test::torus(16, false), test::box(5), test::bumpy(24),
                          test::noisy(test::ball(10), 0.1), test::pierced_plate(2, 3), test::single_triangle()})
    {
        CHECK(check_patches(m, 1) == m.cell_count());
        CHECK(check_patches(m, 8) * 8 >= m.cell_count());
        check_patches(m, 1000);
    }
    CHECK(check_patches(test::grid(10, 10), 1000) == 1);
    CHECK(check_patches(test::ball(12), 10000) <= 12);
}

TEST_CASE("seen_patches: a ramp that winds over itself is parted")
{
    constexpr int around = 24, turns = 3;
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    for (int i = 0; i <= around * turns; ++i)
        for (const double r : {1.0, 1.5})
        {
            const double angle = 2 * std::numbers::pi * i / around;
            points.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.02 * i);
        }
    for (idx i = 0; i < around * turns; ++i)
    {
        cells.push_back({2 * i, 2 * i + 1, 2 * i + 3});
        cells.push_back({2 * i, 2 * i + 3, 2 * i + 2});
    }
    const mesh<triangle> ramp(std::move(points), std::move(cells));
    const idx patches = check_patches(ramp, 1000);
    CHECK(patches >= turns);
    CHECK(patches <= 12 * turns);
}

TEST_CASE("seen_patches: only what is wanted, and not over borders")
{
    const auto m = test::grid(8, 8);
    const auto f = facets(m);
    std::vector<char> wanted(m.cells().size(), 0), keep(f.twin.size(), 0);
    for (std::size_t c = 0; c < wanted.size(); ++c) wanted[c] = c % 5 != 0;
    const auto some = impl::lay_as_seen(m, f, wanted, {}, 1000);
    for (std::size_t c = 0; c < wanted.size(); ++c) CHECK((some.patch[c] >= 0) == (wanted[c] != 0));
    std::fill(wanted.begin(), wanted.end(), char(1));
    for (std::size_t s = 0; s < keep.size(); ++s) keep[s] = f.twin[s] >= 0;
    const auto single = impl::lay_as_seen(m, f, wanted, keep, 1000);
    CHECK(single.energy.size() == m.cells().size());
}

TEST_CASE("seen_patches: none leads from one region into another")
{
    const auto plate = test::grid(10, 10);
    CHECK(check_patches(plate, 1000, impl::octants(plate)) == 4);
    const auto m = test::noisy(test::ball(10), 0.1);
    const auto regions = impl::octants(m);
    CHECK(std::set<char>(regions.begin(), regions.end()) == std::set<char>{1, 2, 3, 4, 5, 6, 7, 8});
    CHECK(check_patches(m, 1000, regions) >= 8);
    const auto laid = impl::lay_as_seen(m, facets(m), regions, {}, 1000);
    std::vector<char> region_of(laid.energy.size(), 0);
    for (std::size_t c = 0; c < regions.size(); ++c)
    {
        char& r = region_of[static_cast<std::size_t>(laid.patch[c])];
        CHECK((r == 0 || r == regions[c]));
        r = regions[c];
    }
}
