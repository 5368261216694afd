// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstddef>
#include <vector>

#include <support/meshes.hpp>
#include <taut/impl/charts/atlas/panel_order.hpp>
#include <taut/impl/core/mesh/incidence.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

/// Every nonzero of the Hessian has a place, and panels reach no further than the next ones.
void check_profile(const mesh<triangle>& m)
{
    const csr near = vertex_neighbours(m);
    const impl::panel_profile profile(near);
    const auto n = m.points().size();
    REQUIRE(profile.order.new_to_old.size() == n);
    REQUIRE(profile.heights.size() == (n + 1) / 2);
    std::vector<char> seen(n, 0);
    for (const idx v : profile.order.new_to_old) ++seen[std::size_t(v)];
    for (const char times : seen) CHECK(times == 1);

    const auto last_of = [&](std::size_t panel) { return 2 * idx(panel) + profile.heights[panel] / 2 - 1; };
    for (std::size_t p = 0; p < profile.heights.size(); ++p)
    {
        CHECK(profile.heights[p] % 4 == 0);
        CHECK(last_of(p) < idx(2 * profile.heights.size()));
        if (p > 0) CHECK(last_of(p) >= last_of(p - 1));
    }
    for (std::size_t i = 0; i < n; ++i)
        for (const idx w : near.row(profile.order.new_to_old[i]))
            CHECK(profile.order.old_to_new[std::size_t(w)] <= last_of(i / 2));
}

} // namespace

TEST_CASE("panel_profile: holds every neighbour of every vertex")
{
    check_profile(test::single_triangle());
    check_profile(test::fan(9, true));
    check_profile(test::cap(7));
    check_profile(test::bumpy(9));
    check_profile(test::annulus(11));
    check_profile(test::two_components());
}

TEST_CASE("panel_profile: a strip has a narrow band, whatever the numbers of its vertices")
{
    auto strip = test::grid(60, 2);
    auto cells = strip.cells();
    const auto n = strip.vertex_count();
    for (auto& t : cells)
        for (idx& v : t) v = idx(v * 64LL % n); // 64 and 183 have no common factor
    auto points = strip.points();
    for (idx v = 0; v < n; ++v) points[std::size_t(v * 64LL % n)] = strip.points()[std::size_t(v)];
    const mesh<triangle> shuffled(points, cells);
    check_profile(shuffled);
    for (const idx height : impl::panel_profile(vertex_neighbours(shuffled)).heights) CHECK(height <= 24);
}

TEST_CASE("panel_profile: the work of a hub is that of a dense matrix")
{
    const double hub = impl::panel_profile(vertex_neighbours(test::fan(400, true))).work;
    const double band = impl::panel_profile(vertex_neighbours(test::grid(200, 1))).work;
    CHECK(hub > 100 * band);
}
