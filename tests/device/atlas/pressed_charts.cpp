// SPDX-License-Identifier: MIT
// Charts are bent into smaller squares within a bound of distortion, and kept from lying on themselves.
#include <cmath>
#include <numbers>
#include <utility>

#include <doctest/doctest.h>

#include <support/shared_context.hpp>
#include <support/strips.hpp>

#include <taut/atlas.hpp>
#include <taut/impl/charts/atlas/cutting/mend_charts.hpp>
#include <taut/impl/charts/atlas/pressed_charts.hpp>
#include <taut/impl/charts/atlas/settled_charts.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

/// An arc of this angle, as one chart, with triangles of about 0.25; every other vertex is above the plane.
chart_set arc(double angle, double height)
{
    constexpr taut::idx along = 40, across = 4;
    std::vector<vec3> points;
    std::vector<std::array<taut::idx, 3>> cells;
    for (taut::idx i = 0; i <= along; ++i)
        for (taut::idx j = 0; j <= across; ++j)
        {
            const double a = angle * i / along, r = 10 / angle + 0.25 * j;
            points.emplace_back(r * std::cos(a), r * std::sin(a), (i + j) % 2 == 0 ? 0 : height);
            if (i == along || j == across) continue;
            const taut::idx v = i * (across + 1) + j, w = v + across + 1;
            cells.push_back({v, v + 1, w + 1});
            cells.push_back({v, w + 1, w});
        }
    const mesh<triangle> m(std::move(points), std::move(cells));
    const auto f = facets(m);
    std::vector<vec2> uv;
    for (const auto& t : m.cells())
        for (const taut::idx v : t) uv.emplace_back(m.points()[static_cast<std::size_t>(v)]);
    return cut(m, f, {std::vector<char>(f.twin.size(), 0), std::move(uv), std::vector<double>(m.cells().size(), 4)});
}

} // namespace

TEST_CASE("pressed charts: the ends of an arc come nearer, within the bound and without overlaps")
{
    queue q(test::shared_context());
    for (const double angle : {0.5, 6.0}) // nearly straight; its ends nearly meet
        for (const double more : {-0.1, 0.02})
        {
            CAPTURE(angle);
            CAPTURE(more);
            chart_set set = arc(angle, 0.1);
            measure(set);
            const double bound = set.energy[0] + more;
            const run_limits unlimited;
            atlas_run run{q, unlimited};
            const auto before = set.uv;
            const double side = least_square::of(before).side;
            const auto launches = q.counters().launches;
            chart_press(run, set, {}, bound).run(5);
            CHECK(q.counters().launches == launches); // on the host
            CHECK(run.report.complete);
            if (more < 0)
            {
                CHECK(set.uv == before);
                continue;
            }
            const double now = least_square::of(set.uv).side;
            CHECK(now < (angle < 1 ? 0.98 : 1.001) * side);
            CHECK(set.energy[0] <= bound);
            const double energy = set.energy[0];
            measure(set);
            CHECK(set.energy[0] == doctest::Approx(energy));
            CHECK_FALSE(overlaps_itself(set.charts, 0, set.uv));
            CHECK(turned_triangle(set.charts, 0, set.uv) < 0);
            chart_set again = arc(angle, 0.1);
            measure(again);
            atlas_run other{q, unlimited};
            chart_press(other, again, {}, bound).run(5);
            CHECK(again.uv == set.uv);
        }
}

TEST_CASE("pressed charts: what is plane stays as it is")
{
    queue q(test::shared_context());
    chart_set set = arc(0.5, 0);
    measure(set);
    const run_limits unlimited;
    atlas_run run{q, unlimited};
    const auto before = set.uv;
    CHECK_FALSE(chart_press(run, set, {}, 4.1).run(5));
    CHECK(set.uv == before);
}

TEST_CASE("kept apart: a small chart that lies on itself is mapped beside itself, on the host")
{
    queue q;
    const auto m = test::ramp(60, 4, 1.4, 0.6, 0.5);
    const auto free = parameterize(q, m);
    REQUIRE(free);
    const auto f = facets(m);
    std::vector<vec2> uv;
    for (const auto& t : m.cells())
        for (const taut::idx v : t) uv.push_back(free.uv[static_cast<std::size_t>(v)]);
    chart_set set =
        cut(m, f, {std::vector<char>(f.twin.size(), 0), std::move(uv), std::vector<double>(m.cells().size(), 4)});
    std::vector<char> bad = crossing_charts(set.charts, set.uv);
    REQUIRE(bad == std::vector<char>{1});
    const run_limits unlimited;
    atlas_run run{q, unlimited};
    const auto launches = q.counters().launches;
    keep_apart(run, set, bad);
    CHECK(q.counters().launches == launches);
    CHECK(bad[0] == 0);
    CHECK(crossing_charts(set.charts, set.uv)[0] == 0);
    CHECK(turned_triangle(set.charts, 0, set.uv) < 0);
    CHECK(set.energy[0] < 4.1);
}

TEST_CASE("kept apart: what does not lie on itself stays flat")
{
    queue q(test::shared_context());
    chart_set set = arc(6.0, 0);
    const run_limits unlimited;
    atlas_run run{q, unlimited};
    std::vector<char> bad{1};
    keep_apart(run, set, bad);
    CHECK(bad[0] == 0);
    CHECK(set.energy[0] == doctest::Approx(4).epsilon(1e-7));
}
