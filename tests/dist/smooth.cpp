// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <dist/pieces.hpp>
#include <taut/certify.hpp>
#include <taut/impl/files/volume/cell_faces.hpp>
#include <taut/smooth.hpp>

namespace taut::test
{

TEST_CASE("dist smooth: as one process, with a boundary that slides")
{
    const auto m = jittered_cube(4, 3);
    const auto p = dealt(MPI_COMM_WORLD, m);
    const auto [x, report] = dist::smooth<tetrahedron>(MPI_COMM_WORLD, p, {.queue = common_queue()});
    CHECK(report.outcome == outcome::valid);
    CHECK(report.converged);
    for (std::size_t v = 0; v < x.size(); ++v)
        for (int k = 0; k < 3; ++k)
            if (p.points[v][k] == 0 || p.points[v][k] == 1) CHECK(x[v][k] == p.points[v][k]);
    queue& q = common_queue();
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
    dist::smooth_params how{.queue = common_queue()};
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
    dist::smooth_params how{.boundary = smooth_boundary::fixed, .queue = common_queue()};
    const auto [x, report] = dist::smooth<tetrahedron>(MPI_COMM_WORLD, p, how);
    CHECK(report.converged);
    for (std::size_t v = 0; v < x.size(); ++v)
        for (int k = 0; k < 3; ++k)
            if (p.points[v][k] == 0 || p.points[v][k] == 1) CHECK(x[v] == p.points[v]);
    if (rank_of() == size_of() - 1) how.fixed = {777777};
    CHECK_THROWS_AS(dist::smooth<tetrahedron>(MPI_COMM_WORLD, p, how), error);
}

TEST_CASE("dist smooth: interfaces between regions, and lines where labelled faces meet, as one process keeps them")
{
    constexpr int n = 2, slice = (n + 1) * (n + 1);
    const auto shaken = bar(n, 4);
    auto points = shaken.points();
    for (std::size_t v = 0; v < points.size(); ++v)
    {
        if (v / slice == 2 * n) points[v].z = 2;                  // the plane in the middle
        if (v < slice && v % (n + 1) == n / 2) points[v].x = 0.5; // a line on one end
    }
    const mesh<tetrahedron> m(points, shaken.cells());
    io::volume_file file;
    file.points = points;
    file.cells = {{io::cell_kind::tetrahedron, {}}, {io::cell_kind::triangle, {}}};
    file.labels = {{"region", true, {}}};
    std::vector<dist::impl::labelled_face> faces;
    for (const auto& c : m.cells())
    {
        file.cells[0].corners.insert(file.cells[0].corners.end(), c.begin(), c.end());
        file.labels[0].values.push_back(1 + (*std::max_element(c.begin(), c.end()) >= slice * (2 * n + 1)));
    }
    for (const auto& c : m.cells())
    {
        dist::impl::labelled_face face;
        std::size_t k = 0;
        double x = 0;
        for (const idx v : c)
            if (v < slice && k < 3) face.vertices[k++] = v, x += points[static_cast<std::size_t>(v)].x;
        if (k < 3) continue;
        face.label = x < 1.5 ? 3 : 4;
        faces.push_back(face);
        for (k = 0; k < 3; ++k) file.cells[1].corners.push_back(static_cast<idx>(face.vertices[k]));
        file.labels[0].values.push_back(face.label);
    }
    REQUIRE(faces.size() == 2 * n * n);
    queue& q = common_queue();
    const auto one = smooth(q, m,
                            smooth_params<tetrahedron>{.kept = file.kept_facets(true),
                                                       .precision = precision::fp64,
                                                       .solve = {.gradient_tolerance = 1e-8}});
    for (int processes = 1; processes <= size_of(); ++processes)
    {
        const first_processes some(processes);
        if (!some) continue;
        const auto p = dealt(some.get(), m);
        dist::smooth_params how{.queue = common_queue()};
        how.solve.gradient_tolerance = 1e-8;
        for (const auto& c : p.cells)
            how.regions.push_back(1 + (*std::max_element(c.begin(), c.end()) >= slice * (2 * n + 1)));
        if (rank_of(some.get()) == processes - 1) how.faces = faces;
        const auto [x, report] = dist::smooth<tetrahedron>(some.get(), p, how);
        CHECK(report.converged);
        CHECK(report.energy == doctest::Approx(one.report.energy).epsilon(1e-10));
        bool moved = false;
        for (std::size_t v = 0; v < x.size(); ++v)
        {
            if (p.ids[v] / slice == 2 * n) CHECK(x[v].z == 2);
            if (p.ids[v] < slice && p.ids[v] % (n + 1) == n / 2) CHECK(x[v].x == 0.5);
            moved = moved || (p.ids[v] / slice == 2 * n && x[v] != p.points[v]);
            CHECK(glm::distance(x[v], one.x[static_cast<std::size_t>(p.ids[v])]) < 1e-6);
        }
        CHECK(dist::impl::communicator(some.get()).any(moved)); // they slide
        how.regions.resize(1);
        CHECK_THROWS_AS(dist::smooth<tetrahedron>(some.get(), p, how), error);
    }
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
