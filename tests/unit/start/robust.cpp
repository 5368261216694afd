// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include <support/extreme_meshes.hpp>
#include <taut/impl/core/start/coarse_start.hpp>

namespace
{

using taut::idx;
using taut::vec2;
using taut::vec3;
using taut::impl::coarse_start;
using taut::impl::robust_start;
using surface = taut::mesh<taut::triangle>;

/// Valid, at the scale of least energy, and below a bound.
void require_good(const taut::start_map& map, const surface& m, double most)
{
    REQUIRE(map.uv.size() == m.points().size());
    const taut::impl::ideal_elements<taut::triangle> ideal(m);
    taut::start_map again;
    again.uv = map.uv;
    assess(again, m, ideal);
    CHECK(map.flips.flipped == 0);
    CHECK(again.flips.flipped == 0);
    CHECK(map.distortion.measure == doctest::Approx(again.distortion.measure).epsilon(1e-9));
    CHECK(map.distortion.measure >= 4 - 1e-9);
    CHECK(map.distortion.measure < most);
    for (const double s : {0.9, 1.1})
    {
        again.uv = map.uv;
        for (vec2& p : again.uv) p *= s;
        assess(again, m, ideal);
        CHECK(again.distortion.measure > map.distortion.measure);
    }
}

surface scaled(const surface& m, double s)
{
    auto points = m.points();
    for (vec3& p : points) p *= s;
    return {points, m.cells()};
}

/// A grid of n by n quads without one in the middle.
surface with_hole(int n)
{
    auto cells = taut::test::grid_cells(n, n);
    const auto middle = cells.begin() + n * n + (n % 2 == 0 ? n : 0); // quad (n / 2, n / 2)
    cells.erase(middle, middle + 2);
    return {taut::test::grid(n, n).points(), cells};
}

} // namespace

TEST_CASE("robust start: a flat surface is mapped without distortion, and gentle ones with little")
{
    require_good(robust_start(taut::test::single_triangle()), taut::test::single_triangle(), 4.001);
    require_good(robust_start(taut::test::fan(5)), taut::test::fan(5), 4.1);
    require_good(robust_start(taut::test::grid(20, 15)), taut::test::grid(20, 15), 4.001);
    require_good(robust_start(taut::test::cap(8)), taut::test::cap(8), 4.4);
    require_good(robust_start(taut::test::cap(16, 2.5)), taut::test::cap(16, 2.5), 6.5);
    require_good(robust_start(taut::test::bumpy(16)), taut::test::bumpy(16), 4.5);
}

TEST_CASE("robust start: tubes far too long for a barycentric map get a valid one of moderate distortion")
{
    // The energy of the best map grows as the length: about 1.1 times length / radius if it is round.
    for (const double aspect : {20.0, 90.0})
    {
        const auto m = taut::test::long_tube(8, aspect);
        CAPTURE(aspect);
        require_good(robust_start(m), m, 8 * aspect);
    }
    const auto coil = taut::test::coiled_tube(8, 3);
    require_good(robust_start(coil), coil, 400);
    const auto plain = taut::test::tube(12, 90); // closed by one fan
    require_good(robust_start(plain, {.tolerance = 0.1}), plain, 1000);
}

TEST_CASE("robust start: closed bodies with a short slit get a valid map of moderate distortion")
{
    for (const int edges : {2, 5, 20})
    {
        CAPTURE(edges);
        const auto ball = taut::test::slit(taut::test::sphere(4), edges);
        require_good(robust_start(ball), ball, 15);
        const auto animal = taut::test::slit(taut::test::animal(24), edges);
        require_good(robust_start(animal), animal, 100);
    }
    const auto star = taut::test::star_of_tubes(40, 4);
    require_good(robust_start(star), star, 60);
}

TEST_CASE("robust start: units do not matter")
{
    const auto m = taut::test::slit(taut::test::sphere(3), 3);
    const auto map = robust_start(m);
    for (const double s : {0x1p-300, 0x1p200})
    {
        const auto other = robust_start(scaled(m, s));
        CHECK(other.distortion.measure == map.distortion.measure);
        for (std::size_t v = 0; v < map.uv.size(); ++v) CHECK(other.uv[v] == s * map.uv[v]);
    }
}

TEST_CASE("robust start: surfaces with holes are mapped with their holes")
{
    const auto m = with_hole(20);
    const auto map = robust_start(m);
    CHECK(map.holes == 1);
    require_good(map, m, 4.01);
    const auto ring = taut::test::annulus(40);
    require_good(robust_start(ring), ring, 4.2);
}

TEST_CASE("tube start: a long tube with both ends open is mapped on concentric rings, and other surfaces are not")
{
    // around: vertices of a ring; taper: the last radius by the first one; bend: the angle of the whole tube
    struct tube
    {
        int around, rings;
        double spacing, taper = 1, bend = 0, noise = 0;
        bool hole = false;
    };
    for (const auto& t :
         {tube{6, 101, 0.6}, tube{8, 101, 0.5}, tube{6, 200, 1.5}, tube{32, 120, 1}, tube{12, 150, 0.25, 0.2},
          tube{8, 150, 0.4, 1, 3}, tube{8, 150, 0.4, 1, 0, 0.02}, tube{6, 150, 0.5, 1, 0, 0, true}})
    {
        CAPTURE(t.around);
        CAPTURE(t.rings);
        std::vector<vec3> points;
        std::vector<std::array<idx, 3>> cells;
        double area = 0, along = 0;
        const auto wave = [&](int k) { return t.noise * std::sin(37.0 * k * k); };
        for (int k = 0; k < t.rings; ++k)
            for (int i = 0; i < t.around; ++i)
            {
                const double a = 2 * std::numbers::pi * i / t.around, s = k * t.spacing;
                const double r = 0.5 * (1 + (t.taper - 1) * k / (t.rings - 1));
                const double x = r * std::cos(a) + wave(3 * (k * t.around + i)),
                             y = r * std::sin(a) + wave(k * t.around + i);
                const double length = (t.rings - 1) * t.spacing;
                points.emplace_back(t.bend == 0 ? vec3(x, y, s)
                                                : vec3((length / t.bend + x) * std::cos(s / length * t.bend), y,
                                                       (length / t.bend + x) * std::sin(s / length * t.bend)));
            }
        for (int k = 0; k + 1 < t.rings; ++k)
            for (int i = 0; i < t.around; ++i)
            {
                if (t.hole && k == t.rings / 2 && i == 0) continue;
                const idx a = k * t.around + i, b = k * t.around + (i + 1) % t.around;
                cells.push_back({a, b, b + t.around});
                cells.push_back({a, b + t.around, a + t.around});
            }
        const surface m(points, cells);
        for (const auto& c : cells)
        {
            const auto at = [&](std::size_t k) { return points[std::size_t(c[k])]; };
            area += glm::length(glm::cross(at(1) - at(0), at(2) - at(0))) / 2;
        }
        along = (t.rings - 1) * t.spacing;
        require_good(
            taut::impl::tube_start(m, taut::impl::ideal_elements<taut::triangle>(m), taut::boundary_loops(m), {}), m,
            9 * along * along / area);
    }
    for (const auto& m : {with_hole(20), taut::test::annulus(40), taut::test::grid(4, 4)})
        CHECK(taut::impl::tube_start(m, taut::impl::ideal_elements<taut::triangle>(m), taut::boundary_loops(m), {})
                  .uv.empty());
}

TEST_CASE("robust start: a fixed boundary stays on the outline")
{
    const auto m = taut::test::bumpy(20, 0.5);
    const auto map = robust_start(m, {.fixed_boundary = true});
    const auto reference = taut::impl::barycentric_map(m);
    CHECK(map.flips.flipped == 0);
    CHECK(map.distortion.measure < reference.distortion.measure);
    const auto loops = taut::boundary_loops(m);
    for (const taut::idx v : loops[0])
        CHECK(glm::distance(map.uv[std::size_t(v)], reference.uv[std::size_t(v)]) < 1e-12);
}

TEST_CASE("robust start: it ends early where it is told to")
{
    const auto m = taut::test::slit(taut::test::sphere(3), 3);
    const auto far = robust_start(m, {.tolerance = 1e-4, .iterations = 200});
    const auto near = robust_start(m, {.enough = 100});
    CHECK(near.flips.flipped == 0);
    CHECK(near.distortion.measure > far.distortion.measure);
    int asked = 0;
    const auto stopped = robust_start(m, {.proceed = [&asked] { return ++asked < 3; }});
    CHECK(asked >= 3);
    CHECK(stopped.flips.flipped == 0);
}

TEST_CASE("robust start: closed surfaces and parameters out of range are refused")
{
    CHECK_THROWS_AS(robust_start(taut::test::octahedron()), taut::mesh_error);
    const auto m = taut::test::grid(3, 3);
    CHECK_THROWS_AS(robust_start(m, {.tolerance = 0}), taut::parameter_error);
    CHECK_THROWS_AS(robust_start(m, {.tolerance = 2}), taut::parameter_error);
    CHECK_THROWS_AS(robust_start(m, {.enough = -1}), taut::parameter_error);
    CHECK_THROWS_AS(robust_start(m, {.iterations = -1}), taut::parameter_error);
    const auto h = taut::impl::make_hierarchy(m);
    CHECK_THROWS_AS(coarse_start(m, h, {.vertices = 2}), taut::parameter_error);
    CHECK_THROWS_AS(coarse_start(taut::test::grid(4, 4), h), taut::parameter_error);
}

TEST_CASE("coarse start: fine surfaces are mapped through their hierarchy, the same on any number of threads")
{
    for (const auto& m : {taut::test::cap(60, 2.5), taut::test::bumpy(70, 0.4), taut::test::long_tube(14, 20)})
    {
        const auto h = taut::impl::make_hierarchy(m);
        REQUIRE(h.levels.size() > 2);
        const auto map = coarse_start(m, h, {.vertices = 300, .coarse = {.threads = 1}});
        require_good(map, m, 200);
        CHECK(coarse_start(m, h, {.vertices = 300, .coarse = {.threads = 4}}).uv == map.uv);
        CHECK(map.distortion.measure < taut::impl::barycentric_map(m).distortion.measure);
    }
}

TEST_CASE("coarse start: a distortion that grows from level to level is put right on the way")
{
    const auto m = taut::test::long_tube(8, 150);
    require_good(coarse_start(m, taut::impl::make_hierarchy(m), {.vertices = 200}), m, 2000);
}

TEST_CASE("coarse start: a fixed boundary stays on the outline")
{
    const auto m = taut::test::cap(40, 2);
    std::vector<char> keep(m.points().size(), 0);
    const auto loop = taut::boundary_loops(m)[0];
    for (const taut::idx v : loop) keep[std::size_t(v)] = 1;
    const auto map =
        coarse_start(m, taut::impl::make_hierarchy(m, keep), {.vertices = 600, .coarse = {.fixed_boundary = true}});
    const auto reference = taut::impl::barycentric_map(m);
    CHECK(map.flips.flipped == 0);
    CHECK(map.distortion.measure < reference.distortion.measure);
    for (const taut::idx v : loop) CHECK(glm::distance(map.uv[std::size_t(v)], reference.uv[std::size_t(v)]) < 1e-9);
}

TEST_CASE("coarse start: a hierarchy without the boundary that is to be fixed is refused")
{
    const auto m = taut::test::cap(20, 2);
    CHECK_THROWS_AS(
        coarse_start(m, taut::impl::make_hierarchy(m), {.vertices = 100, .coarse = {.fixed_boundary = true}}),
        taut::parameter_error);
}

TEST_CASE("coarse start: the outline is the longest boundary loop of the fine surface")
{
    const auto m = with_hole(60);
    const auto map = coarse_start(m, taut::impl::make_hierarchy(m), {.vertices = 100});
    require_good(map, m, 4.01);
    CHECK(map.holes == 1);
    CHECK(taut::boundary_loops(m)[map.outline].size() == 240);
}

TEST_CASE("coarse start: units do not matter")
{
    const auto m = taut::test::cap(40, 2.5);
    const auto map = coarse_start(m, taut::impl::make_hierarchy(m));
    const auto large = scaled(m, 0x1p300);
    CHECK(coarse_start(large, taut::impl::make_hierarchy(large)).distortion.measure == map.distortion.measure);
}
