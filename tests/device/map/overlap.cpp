// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <random>
#include <thread>
#include <utility>

#include <doctest/doctest.h>

#include <support/shared_context.hpp>
#include <support/size.hpp>
#include <support/strips.hpp>

#include <taut/energies.hpp>
#include <taut/impl/core/core/budget.hpp>
#include <taut/impl/core/map/overlap/scaffold.hpp>
#include <taut/impl/core/map/overlap/start_apart.hpp>
#include <taut/parameterize.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

mesh<triangle> winding_ramp()
{
    return test::ramp(test::sized(60, 40), 4, 1.4, 0.6, 0.5);
}

/// Isometric times an attribute, and a pull along the direction of the cell.
struct drawn_along
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return e.attribute(0) * energy::isometric{}(e) + 0.3 * (e.S[0][0] * e.S[0][0] + e.S[0][1] * e.S[0][1]);
    }
};

/// Crossings of the boundary, counted here.
std::size_t crossings_of(const mesh<triangle>& m, const std::vector<vec2>& uv)
{
    const auto loops = boundary_loops(m);
    return boundary_crossings(loops, uv);
}

/// Certified, and without crossings, as the report says.
void check_apart(const mesh<triangle>& m, const map_result& r)
{
    CAPTURE(r.reason());
    REQUIRE(r);
    CHECK(certify<2>(m.cells(), std::span<const vec2>(r.uv)));
    CHECK(crossings_of(m, r.uv) == 0);
    REQUIRE(r.report.overlap);
    CHECK(r.report.overlap->crossings == 0);
}

TEST_CASE("no_overlap: a ramp of more than one turn lies on itself without it and beside itself with it")
{
    queue q(test::shared_context());
    const auto m = winding_ramp();
    const auto free = parameterize(q, m);
    REQUIRE(free);
    CHECK_FALSE(free.report.overlap);
    const std::size_t before = crossings_of(m, free.uv);
    CHECK(before > 0);
    const auto r = parameterize(q, m, {.no_overlap = true});
    check_apart(m, r);
    CHECK(r.report.overlap->before.pairs == before);
    CHECK(r.report.overlap->energy_before == doctest::Approx(free.report.solve.value));
    CHECK(r.report.overlap->rounds > 0);
    CHECK(r.report.solve.value > free.report.solve.value);
    CHECK(r.report.solve.value < 4.1);
    const ideal_elements<triangle> ideal(m);
    CHECK(mean_over<triangle>(m, ideal, r.uv, energy::isometric{}).measure == doctest::Approx(r.report.solve.value));
    CHECK(parameterize(q, m, {.no_overlap = true}).uv == r.uv);
}

TEST_CASE("no_overlap: a map that does not cross itself is the same with it, bit for bit")
{
    queue q(test::shared_context());
    const auto m = test::bumpy(test::sized(12, 6));
    const auto free = parameterize(q, m);
    const auto r = parameterize(q, m, {.no_overlap = true});
    check_apart(m, r);
    CHECK(r.report.overlap->before.pairs == 0);
    CHECK(r.report.overlap->rounds == 0);
    CHECK(r.uv == free.uv);
}

TEST_CASE("no_overlap: teeth that meet in the hole of a ring stay out of each other's way")
{
    queue q(test::shared_context());
    const auto m = test::crown(4, 3, 15);
    const auto free = parameterize(q, m, {.holes = true});
    REQUIRE(free);
    CHECK(crossings_of(m, free.uv) > 0);
    for (const auto boundary : {boundary_mode::free, boundary_mode::fixed})
    {
        const auto r = parameterize(q, m, {.boundary = boundary, .holes = true, .no_overlap = true});
        check_apart(m, r);
        if (boundary == boundary_mode::free) CHECK(r.report.solve.value < 5);
    }
}

TEST_CASE("no_overlap: who stops it gets a map without crossings all the same")
{
    queue q(test::shared_context());
    const auto m = winding_ramp();
    for (const int asked : {1, 40})
    {
        int left = -1; // from the first iterate of the mesh itself on
        const auto stop = [&](const progress& p)
        {
            if (left < 0 && p.level == 0 && p.usable && p.iterate) left = asked;
            return left < 0 || left-- > 0;
        };
        const auto r = parameterize(q, m, {.no_overlap = true}, {.observer = stop});
        check_apart(m, r);
        CHECK(r.report.solve.stop == solve::stop::user);
    }
}

TEST_CASE("no_overlap: where time ends it, it is time that is told")
{
    queue q(test::shared_context());
    const auto m = winding_ramp();
    int asked = 0;
    const auto count = [&](const progress&) { return ++asked > 0; };
    REQUIRE(parameterize(q, m, {.no_overlap = true})); // kernels are built
    const budget clock;
    REQUIRE(parameterize(q, m, {}, {.observer = count}));
    const int before = std::exchange(asked, 0);
    const auto whole = parameterize(q, m, {.no_overlap = true}, {.observer = count});
    REQUIRE(whole.report.overlap->rounds > 1);
    REQUIRE(asked > before + 8);
    const double limit = 2 * clock.total();
    int ended = 0;
    for (const int more : {1, 2, 3, 4, 6, 8}) // in the first round
    {
        asked = 0;
        const budget run;
        const auto wait = [&](const progress&)
        {
            while (asked == before + more && run.total() < limit)
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
            ++asked;
            return true;
        };
        const auto r = parameterize(q, m, {.no_overlap = true},
                                    {.time_limit = std::chrono::duration<double>(limit), .observer = wait});
        if (!r) continue; // there was none yet
        CAPTURE(more);
        CHECK(r.report.solve.stop == solve::stop::time);
        ++ended;
    }
    CHECK(ended > 0);
}

TEST_CASE("no_overlap: pins hold bit for bit, springs draw")
{
    queue q(test::shared_context());
    const auto m = winding_ramp();
    const auto apart = parameterize(q, m, {.no_overlap = true});
    REQUIRE(apart);
    const auto n = static_cast<std::size_t>(m.vertex_count());
    constraints<triangle> asked(m);
    const idx first = 0, middle = static_cast<idx>(n / 2), quarter = static_cast<idx>(n / 4);
    const auto at = [&](idx v) { return apart.uv[static_cast<std::size_t>(v)]; };
    asked.pin(middle, at(middle)).pin(first, at(first) + vec2(0.05, 0.02)).spring(quarter, at(quarter), 0.01);
    const auto free = parameterize(q, m, {.constraints = asked});
    REQUIRE(free);
    CHECK(crossings_of(m, free.uv) > 0);
    const auto r = parameterize(q, m, {.constraints = asked, .no_overlap = true});
    check_apart(m, r);
    for (const idx v : {first, middle})
        for (int k = 0; k < 2; ++k)
            CHECK(std::bit_cast<std::uint64_t>(r.uv[static_cast<std::size_t>(v)][k]) ==
                  std::bit_cast<std::uint64_t>(asked.pins().at(v).value[k]));
    CHECK(r.report.solve.value < 4.5);
}

TEST_CASE("no_overlap: edges of the boundary that are pinned across each other are refused with their ends")
{
    queue q(test::shared_context());
    const auto m = winding_ramp();
    const auto free = parameterize(q, m);
    const auto edges = impl::edges_of(boundary_loops(m));
    constraints<triangle> pins(m);
    std::vector<idx> ends;
    impl::for_each_meeting(edges, free.uv,
                           [&](std::size_t i, std::size_t j)
                           {
                               ends = {edges[i][0], edges[i][1], edges[j][0], edges[j][1]};
                               return false;
                           });
    REQUIRE(ends.size() == 4);
    for (const idx v : ends) pins.pin(v, free.uv[static_cast<std::size_t>(v)]);
    CHECK(parameterize(q, m, {.constraints = pins}));
    const auto r = parameterize(q, m, {.constraints = pins, .no_overlap = true});
    CHECK_FALSE(r);
    CHECK(r.report.outcome == outcome::infeasible);
    auto told = r.report.ids;
    std::sort(told.begin(), told.end());
    std::sort(ends.begin(), ends.end());
    CHECK(told == ends);
}

TEST_CASE("no_overlap: two vertices pinned to one point, or one to an edge of others, are refused before anything runs")
{
    queue q;
    const auto m = winding_ramp();
    const idx last = m.vertex_count() - 1;
    const auto r =
        parameterize(q, m, {.constraints = constraints(m).pin(0, {1, 2}).pin(last, {1, 2}), .no_overlap = true});
    CHECK(r.report.outcome == outcome::infeasible);
    CHECK(r.report.ids == std::vector<idx>{0, last});
    CHECK(r.uv.empty());
    const auto on = parameterize(
        q, m, {.constraints = constraints(m).pin(0, {0, 0}).pin(1, {1, 0}).pin(last, {0.25, 0}), .no_overlap = true});
    CHECK(on.report.outcome == outcome::infeasible);
    CHECK(on.report.ids == std::vector<idx>{0, 1, last, last});
    // A vertex that slides through it is none of these.
    CHECK(parameterize(q, m, {.constraints = constraints(m).pin(0, {1, 2}).pin_u(last, 1), .no_overlap = true})
              .report.outcome != outcome::infeasible);
}

TEST_CASE("no_overlap: a given map without crossings is gone on from")
{
    queue q(test::shared_context());
    const auto m = winding_ramp();
    const auto apart = parameterize(q, m, {.no_overlap = true});
    REQUIRE(apart);
    const auto again = parameterize(q, m, {.initial = apart.uv, .no_overlap = true});
    check_apart(m, again);
    CHECK(again.report.overlap->before.pairs > 0);
    CHECK(again.report.overlap->rounds < apart.report.overlap->rounds);
    CHECK(again.report.solve.value <= apart.report.solve.value);
}

TEST_CASE("no_overlap: other energies, weights and directions of cells are minimised as without it")
{
    queue q(test::shared_context());
    const auto m = winding_ramp();
    std::mt19937 rng(5);
    cell_data data;
    data.attribute_count = 1;
    for (std::size_t c = 0; c < m.cells().size(); ++c)
    {
        data.weights.push_back(0.5 + double(rng() % 100) / 100);
        data.attributes.push_back(1 + double(rng() % 2));
        data.directions.emplace_back(0, 0, 1);
    }
    const auto r = parameterize(
        q, m, {.energy = drawn_along{}, .weights = energy::weighting::uniform, .data = data, .no_overlap = true});
    check_apart(m, r);
    CHECK(r.report.overlap->rounds > 0);
    CHECK(r.report.solve.value < 1.05 * r.report.overlap->energy_before);
    CHECK(r.report.solve.value > r.report.overlap->energy_before);
    const auto shape = parameterize(q, m, {.energy = energy::shape{}, .no_overlap = true});
    check_apart(m, shape);
    CHECK(shape.report.solve.value < 1.2);
}

TEST_CASE("no_overlap: a tube too long for a map on a polygon gets one that was made on coarser levels")
{
    queue q(test::shared_context());
    const auto m = test::tube(12, 60);
    const parameterize_params params;
    impl::run_clock clock(budget::unlimited, {});
    const impl::run_surface in(m, params);
    const impl::map_run run(q, in, params, clock);
    CHECK(barycentric_map(m, params.barycentric()).distortion.measure > 1e8);
    const auto start = impl::start_apart(run, boundary_loops(m));
    CHECK(start.flips);
    CHECK(start.distortion.measure < 1e4);
    CHECK(crossings_of(m, start.uv) == 0);
}

TEST_CASE("scaffold: it fills the square around a map with holes, each of whose edges has a triangle beyond")
{
    std::vector<vec2> x;
    const auto m = test::annulus(40);
    for (const vec3& p : m.points()) x.emplace_back(p);
    const auto loops = boundary_loops(m);
    const auto s = impl::make_scaffold(loops, x, vec2(-6), vec2(6));
    CHECK(s.points[0] == vec2(-6));
    auto points = m.points();
    for (const vec2& p : s.points) points.emplace_back(p, 0.0);
    auto cells = m.cells();
    cells.insert(cells.end(), s.cells.begin(), s.cells.end());
    const mesh<triangle> whole(points, cells);
    const auto outline = boundary_loops(whole); // throws where it is no surface
    REQUIRE(outline.size() == 1);
    CHECK(outline[0].size() == 4);
    std::vector<vec2> flat;
    double area = 0;
    for (const vec3& p : whole.points()) flat.emplace_back(p);
    for (const auto& c : whole.cells())
        area += orient(flat[std::size_t(c[0])], flat[std::size_t(c[1])], flat[std::size_t(c[2])]).det / 2;
    CHECK(certify<2>(whole.cells(), std::span<const vec2>(flat)));
    CHECK(area == doctest::Approx(144));
}

} // namespace
