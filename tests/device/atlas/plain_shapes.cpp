// SPDX-License-Identifier: MIT
// Shapes of few flat faces: charts without distortion are at hand, and the bound of the mean holds.
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include <doctest/doctest.h>

#include <support/closed_meshes.hpp>
#include <support/shared_context.hpp>
#include <support/strips.hpp>
#include <taut/atlas.hpp>

using namespace taut;

namespace
{

/// A cube whose faces are cut along one diagonal or the other, by the bits of `cut`.
mesh<triangle> cube(unsigned cut)
{
    std::vector<vec3> p;
    for (int v = 0; v < 8; ++v) p.emplace_back(v & 1, v >> 1 & 1, v >> 2);
    const taut::idx quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    std::vector<std::array<taut::idx, 3>> t;
    for (unsigned f = 0; f < 6; ++f)
    {
        const auto& q = quads[f];
        const unsigned k = cut >> f & 1;
        t.push_back({q[k], q[k + 1], q[k + 2]});
        t.push_back({q[k], q[k + 2], q[(k + 3) % 4]});
    }
    return {std::move(p), std::move(t)};
}

/// A closed prism of n sides, its ends cut as fans. radius: of corner k
mesh<triangle> prism(
    int n, double height, double (*radius)(int k) = [](int) { return 1.0; })
{
    std::vector<vec3> p;
    for (const double z : {0.0, height})
        for (int k = 0; k < n; ++k)
        {
            const double angle = 2 * std::numbers::pi * k / n;
            p.emplace_back(radius(k) * std::cos(angle), radius(k) * std::sin(angle), z);
        }
    std::vector<std::array<taut::idx, 3>> t;
    for (int k = 0; k < n; ++k)
    {
        const int next = (k + 1) % n;
        t.push_back({k, next, n + next});
        t.push_back({k, n + next, n + k});
        if (k > 0 && k + 1 < n)
        {
            t.push_back({0, k + 1, k});
            t.push_back({n, n + k, n + k + 1});
        }
    }
    return {std::move(p), std::move(t)};
}

/// A closed cone of n sides.
mesh<triangle> cone(int n, double height)
{
    std::vector<vec3> p;
    for (int k = 0; k < n; ++k)
        p.emplace_back(std::cos(2 * std::numbers::pi * k / n), std::sin(2 * std::numbers::pi * k / n), 0.0);
    p.emplace_back(0.0, 0.0, height);
    std::vector<std::array<taut::idx, 3>> t;
    for (int k = 0; k < n; ++k)
    {
        t.push_back({k, (k + 1) % n, n});
        if (k > 0 && k + 1 < n) t.push_back({0, k + 1, k});
    }
    return {std::move(p), std::move(t)};
}

/// Steps that go down along x, as boxes one unit deep that fill the stairs.
mesh<triangle> stairs(int steps)
{
    std::set<test::cube_cell> boxes;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; i + j < steps; ++j) boxes.insert({i, 0, j});
    return test::cubes(boxes, 1);
}

/// Body, head, arms and legs.
mesh<triangle> figure()
{
    std::set<test::cube_cell> boxes;
    for (int x = 0; x < 3; ++x)
        for (int z = 4; z < 8; ++z) boxes.insert({x, 0, z});
    for (int z = 8; z < 10; ++z) boxes.insert({1, 0, z});
    for (int x = 1; x < 4; ++x)
    {
        boxes.insert({-x, 0, 7});
        boxes.insert({2 + x, 0, 7});
    }
    for (int z = 0; z < 4; ++z)
    {
        boxes.insert({0, 0, z});
        boxes.insert({2, 0, z});
    }
    return test::cubes(boxes, 1);
}

/// A toothed wheel, its ends cut as fans: borders of its charts lie on each other.
mesh<triangle> gear(int teeth)
{
    return prism(4 * teeth, 0.5, [](int k) { return k % 4 < 2 ? 1.5 : 1.1; });
}

void check_bound(queue& q, const mesh<triangle>& m, double bound, std::size_t most_charts = 6)
{
    atlas_params p;
    p.charts.mean_distortion = bound;
    const auto a = make_atlas(q, m, p);
    REQUIRE(bool(a));
    CHECK(a.report.flips.flipped == 0);
    CHECK(a.report.overlaps == 0);
    CHECK(a.report.distortion <= bound);
    CHECK(a.report.charts.size() <= most_charts);
}

} // namespace

TEST_CASE("make_atlas: cubes and prisms keep the bound, however they are cut and however tight it is")
{
    queue q(test::shared_context());
    for (unsigned cut = 0; cut < 64; cut += 3)
    {
        CAPTURE(cut);
        check_bound(q, cube(cut), 4.1);
    }
    for (const int sides : {6, 8, 48})
        for (const double height : {0.2, 3.0})
            for (const double bound : {4.1, 4.02, 4.004})
            {
                CAPTURE(sides);
                CAPTURE(height);
                check_bound(q, prism(sides, height), bound);
            }
}

TEST_CASE("make_atlas: cones, cylinders, stairs and figures of boxes keep the bound with few charts")
{
    queue q(test::shared_context());
    for (const double bound : {4.1, 4.02})
    {
        CAPTURE(bound);
        for (const int sides : {5, 12, 40})
            for (const double height : {0.5, 3.0})
            {
                CAPTURE(sides);
                CAPTURE(height);
                check_bound(q, cone(sides, height), bound);
            }
        check_bound(q, prism(100, 2), bound); // a cylinder whose ends are slivers
        check_bound(q, prism(16, 8), bound);
        for (const int steps : {2, 3, 6}) // 2: an L
        {
            CAPTURE(steps);
            check_bound(q, stairs(steps), bound, 10);
        }
        check_bound(q, figure(), bound, 12);
        check_bound(q, gear(8), bound, 12);
    }
}

TEST_CASE("make_atlas: what unrolls is one chart without seams or distortion, with holes or as thin as a thread")
{
    queue q(test::shared_context());
    const auto plane = [](double x, double y) { return vec3(x, y, 0.0); };
    const auto coil = [](double x, double y) { return vec3(std::cos(20 * x), std::sin(20 * x), 2 * x + 1e-3 * y); };
    const auto needles = [](double x, double y) { return vec3(1e-4 * x, y, 0.1 * y * y); };
    const auto in_sheet = [](int i, int j) { return i / 4 % 2 == 0 || j / 4 % 2 == 0; };
    const auto all = [](int, int) { return true; };
    for (const auto& m :
         {test::sheet(20, 20, plane, in_sheet), test::sheet(1000, 2, coil, all), test::sheet(200, 2, needles, all)})
    {
        const auto a = make_atlas(q, m);
        REQUIRE(bool(a));
        CHECK(a.report.charts.size() == 1);
        CHECK(a.report.seam_length == 0);
        CHECK(a.report.distortion == doctest::Approx(4).epsilon(1e-4));
    }
}

TEST_CASE("make_atlas: a long rod is cut along its length and around its ends")
{
    queue q(test::shared_context());
    check_bound(q, prism(200, 100), 4.1, 3);
}

TEST_CASE("make_atlas: a long chart is cut across where that fills the square, at little cost")
{
    queue q(test::shared_context());
    std::set<test::cube_cell> boxes;
    for (int x = 0; x < 60; ++x) boxes.insert({x, 0, 0});
    const auto m = test::cubes(boxes, 1);
    const auto with = make_atlas(q, m, atlas_params{});
    atlas_params p;
    p.prefer = chart_preference::one;
    const auto without = make_atlas(q, m, p);
    REQUIRE(bool(with));
    REQUIRE(bool(without));
    CHECK(with.report.utilization > without.report.utilization + 0.1);
    CHECK(with.report.seam_length < 1.2 * without.report.seam_length);
}

TEST_CASE("make_atlas: copies that lie on each other have the least distorted of their maps")
{
    queue q(test::shared_context());
    const auto one = cube(63);
    auto points = one.points();
    auto cells = one.cells();
    for (const vec3& x : one.points()) points.push_back(x + vec3(3, 0, 0));
    for (const auto& t : one.cells()) cells.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
    atlas_params p{.stack = true};
    const auto a = make_atlas(q, mesh<triangle>(std::move(points), std::move(cells)), p);
    REQUIRE(bool(a));
    CHECK(a.report.stacked > 0);
    CHECK(a.report.distortion <= 4.1);
}

TEST_CASE("make_atlas: densities of triangles are factors of the lengths of their charts")
{
    queue q(test::shared_context());
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    for (const int k : {0, 1})
    {
        const auto one = cube(0);
        for (auto t : one.cells()) cells.push_back({t[0] + 8 * k, t[1] + 8 * k, t[2] + 8 * k});
        for (const vec3& p : one.points()) points.push_back(p + vec3(3 * k, 0, 0));
    }
    const mesh<triangle> m(points, cells);
    atlas_params params;
    for (std::size_t c = 0; c < cells.size(); ++c) params.packing.densities.push_back(c < 12 ? 1 : 2);
    const atlas made = make_atlas(q, m, params);
    REQUIRE(bool(made));
    const auto corners = made.corners();
    double area[2] = {0, 0};
    for (std::size_t c = 0; c < corners.size(); ++c)
    {
        const auto at = [&](std::size_t k) { return made.uv[static_cast<std::size_t>(corners[c][k])]; };
        area[c / 12] += glm::determinant(mat2(at(1) - at(0), at(2) - at(0)));
    }
    CHECK(area[1] == doctest::Approx(4 * area[0]).epsilon(0.01)); // charts are not quite isometric

    params.packing.densities.pop_back();
    CHECK_THROWS_AS(make_atlas(q, m, params), parameter_error);
    CHECK_THROWS_AS(make_atlas(q, m, {.packing = {.groups = {0}}}), parameter_error);
}
