// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <support/meshes.hpp>
#include <taut/impl/charts/atlas/chart_start.hpp>

using namespace taut;

namespace
{

impl::chart_start start_of(const mesh<triangle>& m, std::vector<vec2> given = {})
{
    auto start = impl::chart_start::of(m, taut::impl::ideal_elements<triangle>(m), std::move(given));
    CHECK(certify<2>(m.cells(), start.uv));
    return start;
}

} // namespace

TEST_CASE("chart_start: a flat chart begins as it is, wherever it lies")
{
    auto m = test::flat_disk(4);
    auto points = m.points();
    for (vec3& p : points) p = {0.6 * p.x - 3, p.y + 5, 0.8 * p.x};
    CHECK(start_of({points, m.cells()}).energy == doctest::Approx(4));
}

TEST_CASE("chart_start: a chart that folds when it is seen along its normal begins on a circle")
{
    for (const auto& m : {test::tube(12, 2), test::cap(5, 2.5)})
    {
        CHECK_FALSE(certify<2>(m.cells(), impl::projected(m)));
        CHECK(start_of(m).energy < 20);
    }
    CHECK(start_of(test::annulus(8)).energy == doctest::Approx(4)); // a hole is no fold
}

TEST_CASE("chart_start: what unrolls begins unrolled, however long and thin")
{
    const auto coil = [](double turns, double width)
    {
        const auto square = test::grid(200, 2);
        auto points = square.points();
        for (vec3& p : points)
        {
            const double angle = 2 * std::numbers::pi * turns * p.x;
            p = {std::cos(angle), std::sin(angle), width * p.y};
        }
        return mesh<triangle>(points, square.cells());
    };
    for (const auto& m : {coil(0.95, 50), coil(0.95, 1e-5), coil(3, 0.1)})
    {
        CHECK_FALSE(certify<2>(m.cells(), impl::projected(m)));
        CHECK(start_of(m).energy == doctest::Approx(4).epsilon(1e-9));
    }
}

TEST_CASE("chart_start: a given map counts where it has no flips")
{
    const auto m = test::grid(3, 3);
    std::vector<vec2> wide, mirrored;
    for (const vec3& p : m.points())
    {
        wide.emplace_back(5 * p.x, p.y);
        mirrored.emplace_back(-p.x, p.y);
    }
    CHECK(start_of(m, wide).uv == wide);
    CHECK(start_of(m, mirrored).energy == doctest::Approx(4));
}

TEST_CASE("chart_start: what has no map is refused with its fault")
{
    const auto fault = [](const mesh<triangle>& m)
    {
        try
        {
            start_of(m);
        }
        catch (const mesh_error& e)
        {
            return e.fault();
        }
        return mesh_error::empty;
    };
    CHECK(fault(test::octahedron()) == mesh_error::closed_surface);
    CHECK(fault(test::torus(5, true)) == mesh_error::handles);
}

TEST_CASE("single_chart: is brought near 1 by a power of two")
{
    auto m = test::grid(2, 2);
    auto points = m.points();
    for (vec3& p : points) p = 3e-5 * p + vec3(100, 0, 0);
    const mesh<triangle> small(points, m.cells());
    const auto f = taut::impl::facets(small);
    const auto chart = impl::single_chart::of(cut_charts(small, f, std::vector<char>(f.twin.size(), 0)), 0);
    CHECK(chart.unit == 65536);
    CHECK(chart.surface.points()[8].x == doctest::Approx(3e-5 * 65536).epsilon(1e-6));
}
