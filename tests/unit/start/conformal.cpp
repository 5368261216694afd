// SPDX-License-Identifier: MIT
#include <cmath>

#include <doctest/doctest.h>

#include <support/extreme_meshes.hpp>
#include <taut/impl/core/measure/singular_values.hpp>
#include <taut/impl/core/start/conformal.hpp>

namespace
{

using surface = taut::mesh<taut::triangle>;

/// Area mean of s1 / s2: 1 where all angles are kept.
double angular(const surface& m, const std::vector<taut::vec2>& uv)
{
    const taut::impl::ideal_elements<taut::triangle> ideal(m);
    double sum = 0, total = 0;
    for (std::size_t c = 0; c < m.cells().size(); ++c)
    {
        const auto e = taut::impl::mapped_element<taut::triangle>(m, ideal, uv, c);
        const auto s = taut::impl::singular_values<2>(e.S);
        sum += e.measure * s[0] / s[1];
        total += e.measure;
    }
    return sum / total;
}

} // namespace

TEST_CASE("conformal start: surfaces that unroll flat are mapped without distortion")
{
    for (const int n : {5, 30})
    {
        const auto m = taut::test::grid(n, n + 3);
        CHECK(taut::impl::conformal_start(m, taut::impl::facets(m)).distortion.measure ==
              doctest::Approx(4).epsilon(1e-6));
        // Rolled up to three quarters of a cylinder: the edges across are chords, still flat.
        auto points = m.points();
        for (auto& p : points) p = {std::cos(4.7 * p.x), p.y, std::sin(4.7 * p.x)};
        const surface rolled(points, m.cells());
        const auto map = taut::impl::conformal_start(rolled, taut::impl::facets(rolled));
        CHECK(map.flips.flipped == 0);
        CHECK(map.distortion.measure == doctest::Approx(4).epsilon(1e-4));
    }
}

TEST_CASE("conformal start: angles of a cap are kept, the better the finer it is")
{
    double before = 2;
    for (const int n : {6, 12, 24, 48})
    {
        const auto m = taut::test::cap(n, 2.2);
        const auto map = taut::impl::conformal_start(m, taut::impl::facets(m));
        CHECK(map.flips.flipped == 0);
        const double now = angular(m, map.uv);
        CHECK(now - 1 < 0.8 * (before - 1));
        CHECK(now < angular(m, taut::impl::barycentric_map(m).uv));
        before = now;
    }
    CHECK(before < 1.05);
}

TEST_CASE("conformal start: where it would flip triangles another map is taken")
{
    for (const auto& m : {taut::test::bumpy(60, 0.3), taut::test::long_tube(16, 30), taut::test::animal(24)})
    {
        const auto open = taut::boundary_loops(m).empty() ? taut::test::slit(m, 4) : m;
        const auto map = taut::impl::conformal_start(open, taut::impl::facets(open));
        CHECK(map.flips.flipped == 0);
        CHECK(map.uv.size() == open.points().size());
        CHECK(std::isfinite(map.distortion.measure));
    }
}

TEST_CASE("conformal start: units do not matter, and what cannot be mapped is refused")
{
    const auto m = taut::test::cap(10, 2);
    const auto map = taut::impl::conformal_start(m, taut::impl::facets(m));
    auto points = m.points();
    for (auto& p : points) p *= 0x1p-200;
    const surface tiny(points, m.cells());
    const auto other = taut::impl::conformal_start(tiny, taut::impl::facets(tiny));
    for (std::size_t v = 0; v < map.uv.size(); ++v) CHECK(other.uv[v] == 0x1p-200 * map.uv[v]);

    const auto closed = taut::test::octahedron();
    CHECK_THROWS_AS(taut::impl::conformal_start(closed, taut::impl::facets(closed)), taut::mesh_error);
    CHECK_THROWS_AS(taut::impl::conformal_start(m, taut::impl::facets(m), {.iterations = 0}), taut::parameter_error);
    taut::impl::conformal_start_params fixed;
    fixed.fallback.coarse.fixed_boundary = true;
    CHECK_THROWS_AS(taut::impl::conformal_start(m, taut::impl::facets(m), fixed), taut::parameter_error);
}
