// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <support/closed_meshes.hpp>
#include <support/meshes.hpp>
#include <support/shared_context.hpp>
#include <support/size.hpp>
#include <taut/certify.hpp>
#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_start.hpp>
#include <taut/impl/core/start/isometric_newton.hpp>
#include <taut/parameterize.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

using surfaces = std::vector<mesh<triangle>>;

/// Surfaces as the charts of one mesh.
chart_mesh charts_of(const surfaces& parts)
{
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    for (const auto& part : parts)
    {
        const auto first = static_cast<idx>(points.size());
        points.insert(points.end(), part.points().begin(), part.points().end());
        for (auto t : part.cells())
        {
            for (idx& v : t) v += first;
            cells.push_back(t);
        }
    }
    const mesh<triangle> all(std::move(points), std::move(cells));
    const auto f = facets(all);
    return cut_charts(all, f, std::vector<char>(f.twin.size(), 0));
}

mesh<triangle> moved(const mesh<triangle>& m, double scale, vec3 shift)
{
    auto points = m.points();
    for (vec3& p : points) p = scale * p + shift;
    return {std::move(points), m.cells()};
}

/// A strip of n by m quads that winds up a helicoid: `turns` turns of a ribbon between radius 0.3 and 1.
mesh<triangle> spiral(int n, int m, double turns)
{
    auto flat = test::grid(n, m);
    auto points = flat.points();
    for (vec3& p : points)
    {
        const double a = 2 * std::numbers::pi * turns * p.x, r = 0.3 + 0.7 * p.y;
        p = vec3(r * std::cos(a), r * std::sin(a), 0.5 * turns * p.x);
    }
    return {std::move(points), flat.cells()};
}

/// A cylinder slit open along its length.
mesh<triangle> slit_cylinder(int n, int m)
{
    auto flat = test::grid(n, m);
    auto points = flat.points();
    for (vec3& p : points)
    {
        const double a = 2 * std::numbers::pi * p.x;
        p = vec3(std::cos(a), std::sin(a), 2 * p.y);
    }
    return {std::move(points), flat.cells()};
}

mesh<triangle> needle()
{
    return {{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-5, 0}, {0.4, -1e-4, 1e-4}}, {{{0, 1, 2}}, {{1, 0, 3}}}};
}

/// One of each kind of chart that maps.
surfaces kinds()
{
    const int n = test::sized(8, 3);
    return {test::single_triangle(), test::fan(7, true),    test::grid(n, 2),           test::cap(n),
            test::cap(n, 2.6),       test::bumpy(n),        test::bumpy(2 * n, 0.1, 3), test::annulus(2 * n),
            test::tube(2 * n, 2),    spiral(4 * n, 2, 1.6), slit_cylinder(2 * n, 3),    needle()};
}

std::vector<vec2> map_of(const chart_mesh& charts, const flattened_charts& flat, idx k)
{
    const auto first = flat.uv.begin() + charts.first_vertex[std::size_t(k)];
    return {first, flat.uv.begin() + charts.first_vertex[std::size_t(k) + 1]};
}

double energy_of(const mesh<triangle>& m, const std::vector<vec2>& uv)
{
    return mean_over<triangle>(m, ideal_elements<triangle>(m), uv,
                               [](const auto& e) { return impl::bounded(energy::isometric{}, e); })
        .measure;
}

/// What every result must be, whatever the reports say.
void check_maps(const surfaces& parts, const chart_mesh& charts, const flattened_charts& flat)
{
    REQUIRE(flat.charts.size() == parts.size());
    for (std::size_t k = 0; k < parts.size(); ++k)
    {
        CAPTURE(k);
        const auto& report = flat.charts[k];
        CHECK(report.valid);
        CHECK(report.reason == "");
        CHECK(report.outcome == chart_outcome::converged);
        const auto uv = map_of(charts, flat, idx(k));
        CHECK(certify<2>(parts[k].cells(), uv));
        CHECK(report.energy == doctest::Approx(energy_of(parts[k], uv)).epsilon(1e-9));
        CHECK(report.energy <= report.start_energy * (1 + 1e-12));
    }
}

} // namespace

TEST_CASE("flatten_charts: charts of every kind are valid, with the energies that parameterize finds")
{
    queue q(test::shared_context());
    const surfaces parts = kinds();
    const auto charts = charts_of(parts);
    const auto flat = flatten_charts(q, charts);
    check_maps(parts, charts, flat);
    for (std::size_t k = 0; k < parts.size(); ++k)
    {
        CAPTURE(k);
        const auto alone = parameterize(q, parts[k], {.holes = true});
        REQUIRE(alone);
        CHECK(flat.charts[k].energy <= energy_of(parts[k], alone.uv) * (1 + 1e-3));
    }
}

TEST_CASE("flatten_charts: the energy is that of Newton's method on the host")
{
    queue q(test::shared_context());
    const auto m = test::bumpy(test::sized(10, 4));
    const auto charts = charts_of({m});
    const auto flat = flatten_charts(q, charts, {.tolerance = 1e-10});
    const std::vector<char> fixed(m.points().size(), 0);
    impl::isometric_newton host(m.points(), m.cells(), fixed);
    auto x = impl::projected(m);
    double value = host.value(x);
    for (double before = 2 * value; value < before * (1 - 1e-14);) value = host.step(x, before = value);
    CHECK(flat.charts[0].energy == doctest::Approx(value).epsilon(1e-9));
}

TEST_CASE("flatten_charts: by default energies are within 1e-4 of their minima")
{
    queue q(test::shared_context());
    const auto charts = charts_of(kinds());
    const auto usual = flatten_charts(q, charts), exact = flatten_charts(q, charts, {.tolerance = 1e-12});
    for (std::size_t k = 0; k < usual.charts.size(); ++k)
    {
        CHECK(usual.charts[k].energy <= exact.charts[k].energy * (1 + 1e-4));
        CHECK(usual.charts[k].iterations <= exact.charts[k].iterations);
    }
}

TEST_CASE("flatten_charts: 140 charts take the launches of a few, and each has the map that it has alone")
{
    queue q(test::shared_context());
    const surfaces few = kinds();
    surfaces many;
    const std::size_t count = test::sized(140, 20);
    for (std::size_t k = 0; k < count; ++k) many.push_back(few[k * 7 % few.size()]);
    const auto charts = charts_of(many);
    const auto flat = flatten_charts(q, charts);
    check_maps(many, charts, flat);

    const auto some = charts_of(few);
    const auto first = flatten_charts(q, some);
    CHECK(flat.counters.launches == first.counters.launches);
    for (std::size_t k = 0; k < count; ++k)
        CHECK(map_of(charts, flat, idx(k)) == map_of(some, first, idx(k * 7 % few.size())));
    const auto alone = charts_of({few[6]});
    CHECK(map_of(alone, flatten_charts(q, alone), 0) == map_of(some, first, 6));
}

TEST_CASE("flatten_charts: size and place in space change nothing")
{
    queue q(test::shared_context());
    const auto m = test::cap(test::sized(6, 3));
    const surfaces parts = {m, moved(m, 1e-7, vec3(0.0)), moved(m, 1e9, vec3(0.0)), moved(m, 1, vec3(1e6, -1e6, 1e6))};
    const auto charts = charts_of(parts);
    const auto flat = flatten_charts(q, charts);
    for (const auto& report : flat.charts)
    {
        CHECK(report.valid);
        CHECK(report.energy == doctest::Approx(flat.charts[0].energy).epsilon(1e-6));
    }
    // In units of the surface: areas are kept but for the distortion.
    const auto uv = map_of(charts, flat, 1);
    const double width =
        glm::distance(*std::min_element(uv.begin(), uv.end(), [](auto a, auto b) { return a.x < b.x; }),
                      *std::max_element(uv.begin(), uv.end(), [](auto a, auto b) { return a.x < b.x; }));
    CHECK(width > 2e-7);
    CHECK(width < 4e-7);
}

TEST_CASE("flatten_charts: charts without a map say why, and the others stay")
{
    queue q(test::shared_context());
    const mesh<triangle> flat_triangle({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{{0, 1, 2}}});
    const auto charts =
        charts_of({test::cap(3), test::octahedron(), test::torus(5, true), flat_triangle, test::grid(2, 2)});
    const auto flat = flatten_charts(q, charts);
    for (const std::size_t k : {0u, 4u}) CHECK(flat.charts[k].valid);
    const char* words[] = {"no boundary", "handles", "flat"};
    for (std::size_t k = 1; k < 4; ++k)
    {
        CAPTURE(flat.charts[k].reason);
        CHECK_FALSE(flat.charts[k].valid);
        CHECK(flat.charts[k].outcome == flat.no_map);
        CHECK(flat.charts[k].energy == std::numeric_limits<double>::infinity());
        CHECK(flat.charts[k].reason.find(words[k - 1]) != std::string::npos);
        for (const vec2& p : map_of(charts, flat, idx(k))) CHECK(p == vec2(0.0));
    }
}

TEST_CASE("flatten_charts: maps near the barrier come away from it in a few steps")
{
    queue q(test::shared_context());
    auto m = test::grid(3, 3);
    const auto charts = charts_of({m});
    // The inside is pressed against a corner: areas of 1e-9.
    std::vector<vec2> initial;
    for (const vec3& p : m.points()) initial.emplace_back(p.x, p.y);
    for (const std::size_t v : {5u, 6u, 9u, 10u}) initial[v] = 1e-9 * initial[v];
    initial[0] = vec2(-1e-10);
    const auto flat = flatten_charts(q, charts, {.initial = initial});
    CHECK(flat.charts[0].start_energy > 1e9);
    CHECK(flat.charts[0].energy == doctest::Approx(4).epsilon(1e-4));
    CHECK(flat.charts[0].iterations < 80);
}

TEST_CASE("flatten_charts: a given map is the start where it is valid")
{
    queue q(test::shared_context());
    const surfaces parts = {test::bumpy(5), test::cap(4)};
    const auto charts = charts_of(parts);
    auto initial = flatten_charts(q, charts).uv;
    const auto n = std::size_t(charts.first_vertex[1]);
    for (std::size_t v = n; v < initial.size(); ++v) initial[v] *= -1; // turned, which is fine
    for (std::size_t v = 0; v < n; ++v) initial[v].x *= -1;            // mirrored: all triangles are flipped
    const auto flat = flatten_charts(q, charts, {.initial = initial});
    check_maps(parts, charts, flat);
    CHECK(flat.charts[1].start_energy == doctest::Approx(flat.charts[1].energy).epsilon(1e-4));
    CHECK(flat.charts[1].iterations <= 2);
    CHECK(flat.charts[0].iterations > 2);
    CHECK_THROWS_AS(flatten_charts(q, charts, {.initial = std::span(initial).first(3)}), parameter_error);
}

TEST_CASE("flatten_charts: whoever stops it gets valid maps for what has begun")
{
    queue q(test::shared_context());
    const surfaces parts = kinds();
    const auto charts = charts_of(parts);
    int asked = 0;
    const auto some =
        flatten_charts(q, charts, {}, {.observer = [&](const progress& p) { return !(p.value > 0) || ++asked < 3; }});
    int stopped = 0;
    for (const auto& report : some.charts)
    {
        CHECK(report.valid);
        stopped += report.outcome == chart_outcome::stopped;
    }
    CHECK(stopped > 0);
    CHECK(stopped < int(parts.size()));

    const auto none = flatten_charts(q, charts, {}, {.time_limit = std::chrono::seconds(0)});
    for (const auto& report : none.charts)
    {
        CHECK_FALSE(report.valid);
        CHECK(report.outcome == chart_outcome::stopped);
        CHECK(report.reason != "");
    }
    const auto starts = flatten_charts(q, charts, {.max_iterations = 0});
    for (const auto& report : starts.charts)
    {
        CHECK(report.valid);
        CHECK(report.outcome == chart_outcome::iterations);
        CHECK(report.energy == doctest::Approx(report.start_energy).epsilon(1e-12));
    }
}

TEST_CASE("flatten_charts: large charts go to multigrid, with the same energies")
{
    queue q(test::shared_context());
    const surfaces parts = {test::bumpy(test::sized(8, 4)), test::annulus(8), test::octahedron()};
    const auto charts = charts_of(parts);
    const auto dense = flatten_charts(q, charts), large = flatten_charts(q, charts, {.tuning = {.largest = 0}});
    for (std::size_t k = 0; k < 2; ++k)
    {
        CHECK_FALSE(dense.charts[k].multigrid);
        CHECK(large.charts[k].multigrid);
        CHECK(large.charts[k].valid);
        CHECK(large.charts[k].outcome == chart_outcome::converged);
        CHECK(large.charts[k].energy == doctest::Approx(dense.charts[k].energy).epsilon(1e-4));
    }
    CHECK(large.charts[2].outcome == chart_outcome::no_map);
    CHECK(large.charts[2].reason != "");
}

TEST_CASE("flatten_charts: large charts of rough surfaces come near their minima, though the first steps are short")
{
    queue q(test::shared_context());
    const surfaces parts = {test::noisy(spiral(240, 4, 4), 0.05, 1), test::noisy(spiral(120, 10, 2), 0.05, 2)};
    const auto charts = charts_of(parts);
    const auto dense = flatten_charts(q, charts),
               large = flatten_charts(q, charts, {.tuning = {.largest = 0, .rough = true}});
    for (std::size_t k = 0; k < parts.size(); ++k)
    {
        CHECK(large.charts[k].multigrid);
        CHECK(large.charts[k].valid);
        CHECK(large.charts[k].energy - 4 < 1.12 * (dense.charts[k].energy - 4));
    }
}

TEST_CASE("flatten_charts: parameters are looked at")
{
    queue q(test::shared_context());
    const auto charts = charts_of({test::single_triangle()});
    CHECK_THROWS_AS(flatten_charts(q, charts, {.tolerance = 0}), parameter_error);
    CHECK_THROWS_AS(flatten_charts(q, charts, {.max_iterations = -1}), parameter_error);
    CHECK_THROWS_AS(flatten_charts(q, charts, {.tuning = {.largest = -1}}), parameter_error);
    CHECK_THROWS_AS(flatten_charts(q, charts, {}, {.time_limit = std::chrono::seconds(-1)}), parameter_error);
}
