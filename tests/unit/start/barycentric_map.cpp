// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include <doctest/doctest.h>

#include <taut/certify.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>

#include "support/meshes.hpp"

namespace
{

using taut::boundary_spacing;
using taut::vec2;
using taut::vec3;
using taut::impl::barycentric_params;
using taut::impl::barycentric_weights;
using taut::impl::boundary_shape;
using surface = taut::mesh<taut::triangle>;

std::vector<barycentric_params> all_params()
{
    std::vector<barycentric_params> all;
    for (const auto shape : {boundary_shape::circle, boundary_shape::square})
        for (const auto spacing : {boundary_spacing::uniform, boundary_spacing::chord, boundary_spacing::centripetal})
            for (const auto weights : {barycentric_weights::uniform, barycentric_weights::mean_value})
                all.push_back({{shape, spacing}, weights});
    return all;
}

double signed_area(const std::vector<std::array<taut::idx, 3>>& cells, const std::vector<vec2>& uv)
{
    double sum = 0;
    for (const auto& [a, b, c] : cells)
    {
        const vec2 p = uv[static_cast<std::size_t>(b)] - uv[static_cast<std::size_t>(a)];
        const vec2 q = uv[static_cast<std::size_t>(c)] - uv[static_cast<std::size_t>(a)];
        sum += (p.x * q.y - p.y * q.x) / 2;
    }
    return sum;
}

double rest_area(const surface& m)
{
    double sum = 0;
    for (const double a : taut::impl::ideal_elements<taut::triangle>(m).measure) sum += a;
    return sum;
}

/// Every combination of parameters gives an injective map with the area of the surface.
void require_injective(const surface& m)
{
    const auto loops = taut::boundary_loops(m);
    const double area = rest_area(m);
    for (const auto& params : all_params())
    {
        CAPTURE(static_cast<int>(params.boundary.shape));
        CAPTURE(static_cast<int>(params.boundary.spacing));
        CAPTURE(static_cast<int>(params.weights));
        const auto start = taut::impl::barycentric_map(m, params);
        REQUIRE(start.uv.size() == m.points().size());
        CHECK(start.flips.elements == m.cells().size());
        CHECK(start.flips.flipped == 0);
        CHECK(start.flips.min_det > 0);
        CHECK(start.flips.max_det >= 1 - 1e-9);
        CHECK(std::isfinite(start.distortion.measure));
        CHECK(start.distortion.measure >= 4 - 1e-9);
        CHECK(start.residual < 1e-14);
        CHECK(signed_area(m.cells(), start.uv) == doctest::Approx(area).epsilon(1e-10));
        CHECK(taut::boundary_crossings(loops, start.uv) == 0);
    }
}

} // namespace

TEST_CASE("barycentric map: random bumpy disks are injective for every shape, spacing and weight")
{
    for (const std::uint32_t seed : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U})
    {
        CAPTURE(seed);
        require_injective(taut::test::bumpy(12, 0.4, seed));
    }
}

TEST_CASE("barycentric map: grids, whose corner triangles have two boundary edges, are injective")
{
    require_injective(taut::test::grid(1, 1));
    require_injective(taut::test::grid(2, 1));
    require_injective(taut::test::grid(5, 4));
    require_injective(taut::test::grid(40, 1)); // a strip: each interior edge joins two boundary vertices
}

TEST_CASE("barycentric map: surfaces without interior vertices")
{
    require_injective(taut::test::single_triangle());
    for (int n = 2; n < 9; ++n) require_injective(taut::test::fan(n));
}

TEST_CASE("barycentric map: caps and tubes are injective")
{
    require_injective(taut::test::cap(10));
    require_injective(taut::test::cap(10, 3.0)); // nearly the whole sphere through a small opening
    require_injective(taut::test::tube(16, 2));
}

TEST_CASE("barycentric map: slivers of 1e-7 are injective")
{
    auto points = taut::test::grid(8, 8).points();
    for (auto& p : points) p.y *= 1e-7;
    require_injective(surface(points, taut::test::grid(8, 8).cells()));
}

TEST_CASE("barycentric map: mean value weights reproduce a planar convex mesh with its own boundary")
{
    // The unit square on a square with chord spacing is a similarity of the boundary, so of the whole map.
    const auto m = taut::test::bumpy(10, 0.0, 3);
    const auto start = taut::impl::barycentric_map(
        m, {{boundary_shape::square, boundary_spacing::chord}, barycentric_weights::mean_value});
    CHECK(start.distortion.measure == doctest::Approx(4).epsilon(1e-9));
    CHECK(start.distortion.uniform == doctest::Approx(4).epsilon(1e-9));
    CHECK(start.flips.min_det == doctest::Approx(1).epsilon(1e-9));
    CHECK(start.flips.max_det == doctest::Approx(1).epsilon(1e-9));
    const auto uniform = taut::impl::barycentric_map(
        m, {{boundary_shape::square, boundary_spacing::chord}, barycentric_weights::uniform});
    CHECK(uniform.distortion.measure > 4.01);
}

TEST_CASE("barycentric map: every free vertex is the mean of its neighbours")
{
    const auto m = taut::test::bumpy(9, 0.3, 2);
    const auto start = taut::impl::barycentric_map(m, {.weights = barycentric_weights::uniform});
    const auto loops = taut::boundary_loops(m);
    std::vector<char> boundary(m.points().size(), 0);
    for (const auto v : loops[0]) boundary[static_cast<std::size_t>(v)] = 1;
    std::vector<vec2> sum(m.points().size(), vec2(0));
    std::vector<double> count(m.points().size(), 0);
    for (const auto& cell : m.cells())
        for (std::size_t c = 0; c < 3; ++c)
        {
            sum[static_cast<std::size_t>(cell[c])] += start.uv[static_cast<std::size_t>(cell[(c + 1) % 3])];
            count[static_cast<std::size_t>(cell[c])] += 1; // around a closed fan each neighbour comes once
        }
    for (std::size_t v = 0; v < sum.size(); ++v)
        if (!boundary[v]) CHECK(glm::distance(sum[v] / count[v], start.uv[v]) < 1e-14);
}

TEST_CASE("barycentric map: the outline goes round once, counter-clockwise, spaced as asked")
{
    const auto m = taut::test::flat_disk(6);
    const auto loop = taut::boundary_loops(m)[0];
    const auto start = taut::impl::barycentric_map(m, {.boundary = {.spacing = boundary_spacing::uniform}});
    const double step = 2 * std::numbers::pi / static_cast<double>(loop.size());
    for (std::size_t k = 0; k < loop.size(); ++k)
    {
        const vec2 p = start.uv[static_cast<std::size_t>(loop[k])];
        const vec2 q = start.uv[static_cast<std::size_t>(loop[(k + 1) % loop.size()])];
        CHECK(std::atan2(p.x * q.y - p.y * q.x, glm::dot(p, q)) == doctest::Approx(step).epsilon(1e-9));
    }
}

TEST_CASE("barycentric map: a model a hundred orders of magnitude smaller or larger has the same map, scaled")
{
    const auto m = taut::test::bumpy(6, 0.2, 1);
    const auto one = taut::impl::barycentric_map(m);
    for (const int exponent : {-400, 400})
    {
        const double scale = std::ldexp(1.0, exponent);
        auto points = m.points();
        for (auto& p : points) p *= scale;
        const auto other = taut::impl::barycentric_map(surface(points, m.cells()));
        CHECK(other.flips.flipped == 0);
        CHECK(other.distortion.measure == one.distortion.measure);
        for (std::size_t v = 0; v < one.uv.size(); ++v) CHECK(other.uv[v] == one.uv[v] * scale);
    }
}

TEST_CASE("barycentric map: an annulus is mapped with its hole open")
{
    const auto m = taut::test::annulus(24);
    for (const auto& params : all_params())
    {
        const auto start = taut::impl::barycentric_map(m, params);
        CHECK(start.holes == 1);
        CHECK(start.uv.size() == m.points().size());
        CHECK(start.flips.flipped == 0);
        CHECK(taut::boundary_crossings(taut::boundary_loops(m), start.uv) == 0);
    }
}

TEST_CASE("barycentric map: surfaces that are no disk are refused with their fault")
{
    const auto fault = [](const surface& m)
    {
        try
        {
            taut::impl::barycentric_map(m);
        }
        catch (const taut::mesh_error& e)
        {
            return e.fault();
        }
        FAIL("no error");
        return taut::mesh_error::empty;
    };
    CHECK(fault(taut::test::octahedron()) == taut::mesh_error::closed_surface);
    CHECK(fault(taut::test::torus(5, true)) == taut::mesh_error::handles);
    CHECK(fault(taut::test::two_components()) == taut::mesh_error::several_components);
    CHECK(fault(taut::test::bowtie()) == taut::mesh_error::non_manifold_vertex);
    CHECK(fault(taut::test::three_on_an_edge()) == taut::mesh_error::non_manifold_facet);
}

TEST_CASE("barycentric map: a user's solver is asked, and its flaws are reported")
{
    const auto m = taut::test::grid(6, 6);
    std::size_t unknowns = 0;
    const auto lazy = [&unknowns](const taut::impl::barycentric_system& system)
    {
        unknowns = system.size();
        return std::vector<vec2>(system.size(), vec2(0));
    };
    const auto start = taut::impl::barycentric_map(m, {}, lazy);
    CHECK(unknowns == 25);
    CHECK(start.flips.flipped > 0);
    CHECK_FALSE(static_cast<bool>(start.flips));
    CHECK(start.residual > 0.01);
    CHECK(std::isinf(start.distortion.measure));
}

TEST_CASE("barycentric map: stretch rounds lower the distortion of a deep surface and keep it injective")
{
    const auto m = taut::test::tube(16, 4);
    const auto outline = taut::boundary_loops(m)[0];
    for (const auto& base : all_params())
    {
        auto params = base;
        const auto plain = taut::impl::barycentric_map(m, params);
        params.stretch_rounds = 1;
        const auto once = taut::impl::barycentric_map(m, params);
        params.stretch_rounds = 10;
        const auto often = taut::impl::barycentric_map(m, params);
        CHECK(once.flips.flipped == 0);
        CHECK(often.flips.flipped == 0);
        CHECK(once.distortion.measure < 0.1 * plain.distortion.measure);
        CHECK(often.distortion.measure <= once.distortion.measure);
        CHECK(often.residual < 1e-14);
        for (const auto v : outline)
            CHECK(often.uv[static_cast<std::size_t>(v)] == plain.uv[static_cast<std::size_t>(v)]);
    }
}

TEST_CASE("barycentric map: stretch rounds never return a worse map, and none where there is nothing to gain")
{
    const auto flat = taut::test::bumpy(10, 0.0, 3);
    barycentric_params params{{boundary_shape::square, boundary_spacing::chord}, barycentric_weights::mean_value};
    const auto plain = taut::impl::barycentric_map(flat, params);
    params.stretch_rounds = 5;
    const auto rounds = taut::impl::barycentric_map(flat, params);
    CHECK(rounds.distortion.measure <= plain.distortion.measure);
    params.stretch_rounds = 21;
    CHECK_THROWS_AS(taut::impl::barycentric_map(flat, params), taut::parameter_error);
    params.stretch_rounds = -1;
    CHECK_THROWS_AS(taut::impl::barycentric_map(flat, params), taut::parameter_error);
}

TEST_CASE("barycentric map: stretch rounds repair what rounding folds")
{
    // A crooked tube so deep that its closed end is smaller than the spacing of doubles there.
    auto points = taut::test::tube(24, 24).points();
    double k = 0;
    for (auto& p : points)
    {
        k += 1;
        p.x *= (1 + 0.2 * std::sin(k * k)) * (p.x > 0.5 ? 1.6 : 1.0);
        p.y *= 1 + 0.2 * std::sin(7 * k * k);
    }
    const surface m(points, taut::test::tube(24, 24).cells());
    const auto plain = taut::impl::barycentric_map(m);
    CHECK(plain.flips.flipped > 0);
    CHECK(std::isinf(plain.distortion.measure));
    const auto rounds = taut::impl::barycentric_map(m, {.stretch_rounds = 4});
    CHECK(rounds.flips.flipped == 0);
}

TEST_CASE("barycentric map: a slit is a hole whose cone has no area, which needs no weights of its shape")
{
    // A square of 4 by 4 quads whose middle vertex is two, below and above.
    const auto square = taut::test::grid(4, 4);
    auto points = square.points();
    auto cells = square.cells();
    constexpr taut::idx middle = 12;
    for (auto& t : cells)
    {
        double height = 0;
        for (const taut::idx v : t) height += points[static_cast<std::size_t>(v)].y / 3;
        for (taut::idx& v : t)
            if (v == middle && height > 0.5) v = 25;
    }
    points.push_back(points[middle]);
    const surface m(points, cells);
    REQUIRE(taut::boundary_loops(m).size() == 2);
    const auto start = taut::impl::barycentric_map(m);
    CHECK(start.flips);
    CHECK(start.distortion.measure < 5);
}

TEST_CASE("barycentric map: prints what it is")
{
    std::ostringstream out;
    out << taut::impl::barycentric_map(taut::test::single_triangle());
    CHECK(out.str().find("start: 0 of 1 triangles flipped, det 1") == 0);
}
