// SPDX-License-Identifier: MIT
#include <cstddef>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include <support/closed_meshes.hpp>
#include <taut/impl/charts/atlas/chart_set.hpp>
#include <taut/impl/charts/atlas/surface_part.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

/// A closed surface in stripes of triangles, each projected along an axis.
chart_set striped(const mesh<triangle>& m, const facet_table& f)
{
    std::vector<taut::idx> stripe;
    for (taut::idx c = 0; c < m.cell_count(); ++c) stripe.push_back(c / 7);
    chart_set set{seams_between(f, stripe), cut_charts(m, f, seams_between(f, stripe)), {}, {}};
    for (const vec3& x : set.charts.surface.points()) set.uv.emplace_back(x.x, x.y + 2 * x.z);
    for (taut::idx k = 0; k < set.charts.charts(); ++k) set.energy.push_back(4 + k);
    return set;
}

} // namespace

TEST_CASE("chart set: by corners and back it is the same, and parts of it are read and written in place")
{
    const auto m = test::ball(6);
    const auto f = facets(m);
    const chart_set set = striped(m, f);
    REQUIRE(set.charts.charts() > 20);
    laid_surface flat = laid(set);
    const chart_set again = cut(m, f, flat);
    CHECK(again.seam == set.seam);
    CHECK(again.uv == set.uv);
    CHECK(again.energy == set.energy);
    CHECK(again.charts.cell_origins == set.charts.cell_origins);

    std::vector<char> third(set.energy.size(), 0);
    third[3] = 1;
    const auto wanted = by_triangle(set.charts, third);
    const surface_part part = part_of(m, wanted, set.seam);
    REQUIRE(part.charts.charts() == 1);
    CHECK(part.first_triangle(0) == set.charts.first_triangle(3));
    auto uv = part.by_vertex(flat.uv);
    for (vec2& x : uv) x += vec2(10, 0);
    part.write(0, 5, uv, flat);
    const chart_set moved = cut(m, f, flat);
    for (std::size_t v = 0; v < set.uv.size(); ++v)
    {
        const bool own = static_cast<taut::idx>(v) >= set.charts.first_vertex[3] &&
                         static_cast<taut::idx>(v) < set.charts.first_vertex[4];
        CHECK(moved.uv[v] == set.uv[v] + vec2(own ? 10 : 0, 0));
    }
    CHECK(moved.energy[3] == 5);
    CHECK(moved.energy[4] == set.energy[4]);
}

TEST_CASE("chart set: charts without a map, flipped ones and those that overlap themselves are unfit")
{
    const auto m = test::ball(6);
    const auto f = facets(m);
    chart_set set = striped(m, f);
    set.energy[2] = std::numeric_limits<double>::infinity();
    CHECK(unfit(set)[2] == 1);
    measure(set);
    for (std::size_t k = 0; k < set.energy.size(); ++k)
        for (taut::idx c = set.charts.first_cell[k]; c < set.charts.first_cell[k + 1]; ++c)
        {
            const auto& t = set.charts.surface.cells()[static_cast<std::size_t>(c)];
            const auto at = [&](taut::idx v) { return set.uv[static_cast<std::size_t>(v)]; };
            if (orient2d(at(t[0]), at(t[1]), at(t[2])) > 0) continue;
            CHECK(unfit(set)[k] == 1);
            break;
        }
}
