// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <support/closed_meshes.hpp>
#include <support/host_flatten.hpp>
#include <support/meshes.hpp>
#include <taut/certify.hpp>
#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/segment.hpp>
#include <taut/impl/core/mesh/boundary.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

segmentation segment_on_host(const mesh<triangle>& m, const segment_params& params = {}, const run_limits& limits = {})
{
    return segment(
        m, facets(m), [](const chart_mesh& charts) { return test::flatten_on_host(charts); }, params, limits);
}

/// Charts must be flattenable, each with the map that its energy says, and within the bounds.
segmentation check_segmentation(const mesh<triangle>& m, const segment_params& params = {})
{
    auto result = segment_on_host(m, params);
    const auto f = facets(m);
    CHECK(test::check_flattenable(m, f, result.seam) == result.charts.charts());
    REQUIRE(result.energy.size() == static_cast<std::size_t>(result.charts.charts()));
    CHECK(result.report.unmapped == 0);
    CHECK(result.report.above == 0);
    CHECK(result.report.crossing == 0);
    double sum = 0, total = 0;
    for (idx k = 0; k < result.charts.charts(); ++k)
    {
        const auto one = test::chart(result.charts, k);
        const auto uv = std::span<const vec2>(result.uv).subspan(
            static_cast<std::size_t>(result.charts.first_vertex[static_cast<std::size_t>(k)]), one.points().size());
        CHECK(bool(certify<2>(one.cells(), uv)));
        CHECK(boundary_crossings(boundary_loops(one), uv) == 0);
        const std::vector<char> fixed(uv.size(), 0);
        const double energy = impl::isometric_newton(one.points(), one.cells(), fixed).value(uv);
        CHECK(energy == doctest::Approx(result.energy[static_cast<std::size_t>(k)]).epsilon(1e-9));
        CHECK(energy <= params.max_distortion);
        double area = 0;
        for (idx c = 0; c < one.cell_count(); ++c)
        {
            const auto x = one.rest(c);
            area += glm::length(glm::cross(x[1] - x[0], x[2] - x[0])) / 2;
        }
        sum += area * energy;
        total += area;
    }
    CHECK(sum / total == doctest::Approx(result.report.distortion).epsilon(1e-9));
    CHECK(sum / total <= params.mean_distortion);
    return result;
}

double size_of(const mesh<triangle>& m)
{
    double area = 0;
    for (idx c = 0; c < m.cell_count(); ++c)
    {
        const auto x = m.rest(c);
        area += glm::length(glm::cross(x[1] - x[0], x[2] - x[0])) / 2;
    }
    return std::sqrt(area);
}

} // namespace

TEST_CASE("segment: a sphere becomes a few charts within the bounds")
{
    const auto ball = test::ball(12);
    const auto few = check_segmentation(ball);
    CHECK(few.charts.charts() > 1);
    CHECK(few.charts.charts() <= 8);
    CHECK(few.report.seam_length < 5 * size_of(ball));
    const auto many = check_segmentation(ball, {.max_distortion = 4.01, .mean_distortion = 4.002});
    CHECK(many.charts.charts() > few.charts.charts());
}

TEST_CASE("segment: surfaces with handles, holes and several components")
{
    check_segmentation(test::pierced_plate(2, 4));
    check_segmentation(test::torus(24, false));
    check_segmentation(test::torus(24, true));
    check_segmentation(test::tube(24, 4));
    check_segmentation(test::both(test::ball(6), test::pierced_plate(1, 3)));
    check_segmentation(test::without(test::ball(10), [](idx c) { return c % 97 == 5; }));
    check_segmentation(test::noisy(test::ball(10), 0.01));
}

TEST_CASE("segment: what can be unrolled has no distortion, and a disk without any is left whole")
{
    const auto box = check_segmentation(test::box(6));
    CHECK(box.report.distortion < 4.03);
    CHECK(box.charts.charts() <= 6);
    CHECK(check_segmentation(test::flat_disk(10)).charts.charts() == 1);
    CHECK(check_segmentation(test::single_triangle()).charts.charts() == 1);
}

TEST_CASE("segment: seams of a pierced plate lie along its creases")
{
    const auto plate = test::pierced_plate(1, 4);
    const auto f = facets(plate);
    const auto result = check_segmentation(plate);
    double flat = 0;
    for (std::size_t s = 0; s < f.twin.size(); ++s)
    {
        const auto normal = [&](std::size_t c)
        {
            const auto x = plate.rest(static_cast<idx>(c));
            return glm::normalize(glm::cross(x[1] - x[0], x[2] - x[0]));
        };
        const auto t = static_cast<std::size_t>(f.twin[s]);
        if (!result.seam[s] || t < s || glm::dot(normal(s / 3), normal(t / 3)) < 0.5) continue;
        const auto [a, b] = side_vertices(plate, static_cast<idx>(s));
        flat += glm::distance(plate.points()[static_cast<std::size_t>(a)], plate.points()[static_cast<std::size_t>(b)]);
    }
    CHECK(flat < 0.25 * result.report.seam_length);
}

TEST_CASE("segment: given seams stay")
{
    const auto m = test::ball(6);
    const auto f = facets(m);
    std::vector<char> equator(f.twin.size(), 0);
    for (std::size_t s = 0; s < equator.size(); ++s)
    {
        const auto [a, b] = side_vertices(m, static_cast<idx>(s));
        equator[s] = std::abs(m.points()[static_cast<std::size_t>(a)].z) < 1e-9 &&
                     std::abs(m.points()[static_cast<std::size_t>(b)].z) < 1e-9;
    }
    const auto result = check_segmentation(m, {.seams = equator});
    for (std::size_t s = 0; s < equator.size(); ++s)
        if (equator[s]) CHECK(result.seam[s]);
}

TEST_CASE("segment: the same twice, and an observer ends it with what there is")
{
    const auto m = test::noisy(test::ball(8), 0.01);
    const auto one = segment_on_host(m), other = segment_on_host(m);
    CHECK(one.seam == other.seam);
    CHECK(one.uv == other.uv);
    const auto ended = segment_on_host(m, {}, {.observer = [](const progress&) { return false; }});
    CHECK(test::check_flattenable(m, facets(m), ended.seam) == ended.charts.charts());
    CHECK(ended.report.cut + ended.report.united == 0);
}

TEST_CASE("segment: a parameter outside its domain is named")
{
    const auto m = test::octahedron();
    const auto field = [&](const segment_params& p)
    {
        try
        {
            segment_on_host(m, p);
        }
        catch (const parameter_error& e)
        {
            return e.field();
        }
        return std::string();
    };
    CHECK(field({.max_distortion = 4}) == "max_distortion");
    CHECK(field({.mean_distortion = 3}) == "mean_distortion");
    CHECK(field({.tuning = {.cut_rounds = -1}}) == "cut_rounds");
    CHECK(field({.tuning = {.unite_rounds = 101}}) == "unite_rounds");
}

TEST_CASE("segment: a ramp that winds over itself is cut where it does")
{
    constexpr int around = 40, turns = 3;
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    for (int i = 0; i <= around * turns; ++i)
        for (const double r : {2.0, 2.5, 3.0})
        {
            const double a = 2 * std::numbers::pi * i / around;
            points.emplace_back(r * std::cos(a), r * std::sin(a), 0.05 * a);
        }
    for (idx i = 0; i < around * turns; ++i)
        for (const idx k : {0, 1})
        {
            const idx a = 3 * i + k;
            cells.push_back({a, a + 1, a + 4});
            cells.push_back({a, a + 4, a + 3});
        }
    const auto ramp = check_segmentation(mesh<triangle>(points, cells), {.tuning = {.least_fill = 0}});
    CHECK(ramp.charts.charts() <= 2 * turns);
}

TEST_CASE("segment: charts that stay and whose maps were not finished come again with these")
{
    const auto m = test::bumpy(16);
    struct report
    {
        double energy;
        bool valid, done;
        bool settled() const { return done; }
    };
    struct maps
    {
        std::vector<vec2> uv;
        std::vector<report> charts;
    };
    idx hasty = 0, thorough = 0;
    const auto result = segment(m, facets(m),
                                [&](const chart_mesh& charts, std::span<const vec2> start)
                                {
                                    const bool again = !start.empty();
                                    if (again) CHECK(start.size() == charts.surface.points().size());
                                    (again ? thorough : hasty) += charts.charts();
                                    const auto flat = test::flatten_on_host(charts);
                                    maps given{again ? std::vector<vec2>(start.begin(), start.end()) : flat.uv, {}};
                                    for (const auto& c : flat.charts)
                                        given.charts.push_back({c.energy, c.valid, again});
                                    return given;
                                });
    CHECK(thorough == result.charts.charts());
    CHECK(hasty >= thorough);
    CHECK(result.report.unmapped == 0);
}

TEST_CASE("segment: who stops it at once gets pieces without maps")
{
    const auto m = test::bumpy(80);
    idx flattened = 0;
    const auto flatten = [&](const chart_mesh& charts)
    {
        flattened += charts.charts();
        return test::flatten_on_host(charts);
    };
    const auto result = segment(m, flatten, {}, {.observer = [](const progress&) { return false; }});
    CHECK(flattened == 0);
    CHECK(result.report.unmapped == result.charts.charts());
    CHECK(test::check_flattenable(m, facets(m), result.seam) == result.charts.charts());
    CHECK(result.charts.surface.cell_count() == m.cell_count());
}

TEST_CASE("segment: who stops it while first charts are looked at gets pieces without maps, and no seam is moved")
{
    const auto m = test::bumpy(80);
    int calls = 0;
    const auto flatten = [&](const chart_mesh& charts)
    {
        ++calls;
        return test::flatten_on_host(charts);
    };
    const auto result = segment(m, facets(m), flatten, {}, {.observer = [&](const progress&) { return calls == 0; }});
    CHECK(calls == 1);
    CHECK(result.report.unmapped == result.charts.charts());
    CHECK(test::check_flattenable(m, facets(m), result.seam) == result.charts.charts());
}
