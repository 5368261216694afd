// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include <dist/pieces.hpp>
#include <taut/certify.hpp>
#include <taut/smooth.hpp>

namespace taut::test
{

TEST_CASE("dist smooth: as one process, with a boundary that slides")
{
    const auto m = jittered_cube(4, 3);
    const auto p = dealt(MPI_COMM_WORLD, m);
    const auto [x, report] = dist::smooth<tetrahedron>(MPI_COMM_WORLD, p, {});
    CHECK(report.outcome == outcome::valid);
    CHECK(report.converged);
    for (std::size_t v = 0; v < x.size(); ++v)
        for (int k = 0; k < 3; ++k)
            if (p.points[v][k] == 0 || p.points[v][k] == 1) CHECK(x[v][k] == p.points[v][k]);
    queue q;
    const auto one = smooth(q, m, smooth_params<tetrahedron>{.precision = precision::fp64});
    CHECK(report.energy == doctest::Approx(one.report.energy).epsilon(1e-6));
}

TEST_CASE("dist smooth: a tilted cube slides in planes that are no coordinate planes; fixed vertices stay")
{
    const auto straight = jittered_cube(3, 5);
    auto points = straight.points();
    const auto tilted = [](const vec3& p)
    {
        const double c = std::cos(0.4), s = std::sin(0.4);
        const vec3 q(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
        return vec3(q.x, c * q.y - s * q.z, s * q.y + c * q.z);
    };
    for (vec3& p : points) p = tilted(p);
    const mesh<tetrahedron> m(points, straight.cells());
    const auto p = dealt(MPI_COMM_WORLD, m);
    dist::smooth_params how;
    how.fixed = {21};
    const auto [x, report] = dist::smooth<tetrahedron>(MPI_COMM_WORLD, p, how);
    CHECK(report.outcome == outcome::valid);
    const vec3 normal = tilted(vec3(1, 0, 0));
    bool moved = false;
    for (std::size_t v = 0; v < x.size(); ++v)
    {
        if (p.ids[v] == 21) CHECK(x[v] == p.points[v]);
        if (straight.points()[static_cast<std::size_t>(p.ids[v])].x == 0)
            CHECK(glm::dot(x[v] - p.points[v], normal) == doctest::Approx(0).epsilon(1e-12));
        moved = moved || glm::distance(x[v], p.points[v]) > 1e-3;
    }
    CHECK(moved);
}

TEST_CASE("dist smooth: a fixed boundary stays bit for bit; a fault of one process is one of all")
{
    const auto m = jittered_cube(3, 7);
    const auto p = dealt(MPI_COMM_WORLD, m);
    dist::smooth_params how{.boundary = smooth_boundary::fixed};
    const auto [x, report] = dist::smooth<tetrahedron>(MPI_COMM_WORLD, p, how);
    CHECK(report.converged);
    for (std::size_t v = 0; v < x.size(); ++v)
        for (int k = 0; k < 3; ++k)
            if (p.points[v][k] == 0 || p.points[v][k] == 1) CHECK(x[v] == p.points[v]);
    if (rank_of() == size_of() - 1) how.fixed = {777777};
    CHECK_THROWS_AS(dist::smooth<tetrahedron>(MPI_COMM_WORLD, p, how), error);
}

TEST_CASE("dist check: inverted elements by their numbers, as one process counts them")
{
    auto m = bar(3);
    auto points = m.points();
    points[40] += vec3(0.9, 0, 0);
    const mesh<tetrahedron> folded(points, m.cells());
    const auto one = certify<3>(std::span(folded.cells()), std::span<const vec3>(points), {}, 1000);
    const auto all = dist::check(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, folded));
    CHECK(all.elements == folded.cell_count());
    CHECK(all.flipped == static_cast<std::int64_t>(one.flipped));
    REQUIRE(!all.ids.empty());
    for (std::size_t k = 0; k < all.ids.size(); ++k) CHECK(all.ids[k] == one.ids[k]);
    CHECK(!all);
    CHECK(dist::check(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m)));
}

TEST_CASE("dist check: edges that are gone around twice, whoever has their tetrahedra")
{
    // Eight positive tetrahedra around the edge from 0 to 1, over two turns.
    std::vector<vec3> points = {{0, 0, -1}, {0, 0, 1}};
    std::vector<std::array<idx, 4>> cells;
    for (int k = 0; k < 8; ++k)
    {
        const double a = k * std::numbers::pi / 2, r = 1 + 0.05 * k;
        points.emplace_back(r * std::cos(a), r * std::sin(a), 0);
        cells.push_back({0, 1, static_cast<idx>(2 + k), static_cast<idx>(2 + (k + 1) % 8)});
    }
    const mesh<tetrahedron> m(points, cells);
    const auto c = dist::check(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m, {.in_turn = true}));
    const auto one = certify<3>(std::span(m.cells()), std::span<const vec3>(points));
    CHECK(c.flipped == static_cast<std::int64_t>(one.flipped));
    CHECK(c.branched == static_cast<std::int64_t>(one.branched));
    CHECK(c.branched == 1);
    CHECK(c.branch_ids == std::vector<std::int64_t>{0, 1});
}

} // namespace taut::test
