// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include <support/shared_context.hpp>
#include <support/size.hpp>

#include <taut/certify.hpp>
#include <taut/impl/files/volume/volume_file.hpp>
#include <taut/rigid_motion.hpp>
#include <taut/smooth.hpp>
#include <taut/volume_file.hpp>

namespace
{

using namespace taut;
using taut::idx;

/// A bar of n x n x 2n cubes, every other slice of them split into wedges, whose quads meet the cubes.
io::volume_file bar(idx n)
{
    io::volume_file file;
    const auto number = [n](idx i, idx j, idx k) { return (k * (n + 1) + j) * (n + 1) + i; };
    for (idx k = 0; k <= 2 * n; ++k)
        for (idx j = 0; j <= n; ++j)
            for (idx i = 0; i <= n; ++i) file.points.push_back(vec3(i, j, k) / double(n));
    io::cell_block cubes{io::cell_kind::hexahedron, {}}, wedges{io::cell_kind::wedge, {}};
    for (idx k = 0; k < 2 * n; ++k)
        for (idx j = 0; j < n; ++j)
            for (idx i = 0; i < n; ++i)
            {
                const idx c[8] = {
                    number(i, j, k),     number(i + 1, j, k),     number(i + 1, j + 1, k),     number(i, j + 1, k),
                    number(i, j, k + 1), number(i + 1, j, k + 1), number(i + 1, j + 1, k + 1), number(i, j + 1, k + 1)};
                if (i % 2 == 0)
                    cubes.corners.insert(cubes.corners.end(), c, c + 8);
                else
                    for (const auto& w : {std::array{0, 2, 1, 4, 6, 5}, std::array{0, 3, 2, 4, 7, 6}})
                        for (const int corner : w) wedges.corners.push_back(c[corner]);
            }
    file.cells = {cubes, wedges};
    return file;
}

/// A sheet of n x n squares of the plane, every other column split into triangles.
io::volume_file sheet(idx n)
{
    io::volume_file file;
    file.dimension = 2;
    for (idx j = 0; j <= n; ++j)
        for (idx i = 0; i <= n; ++i) file.points.push_back(vec3(i, j, 0) / double(n));
    io::cell_block quads{io::cell_kind::quad, {}}, triangles{io::cell_kind::triangle, {}};
    for (idx j = 0; j < n; ++j)
        for (idx i = 0; i < n; ++i)
        {
            const idx at = j * (n + 1) + i;
            const std::array c{at, at + 1, at + n + 2, at + n + 1};
            if (i % 2 == 0)
                quads.corners.insert(quads.corners.end(), c.begin(), c.end());
            else
                for (const int corner : {0, 1, 2, 0, 2, 3}) triangles.corners.push_back(c[corner]);
        }
    file.cells = {quads, triangles};
    return file;
}

bool all_valid(const io::volume_file& file, const std::vector<vec3>& x)
{
    bool valid = true;
    io::impl::for_each_cell(file, 3,
                            [&](io::cell_kind, idx, std::span<const idx> corners)
                            {
                                std::vector<vec3> places;
                                for (const idx v : corners) places.push_back(x[static_cast<std::size_t>(v)]);
                                valid = valid && validity_of_cell(places) == cell_validity::valid;
                            });
    return valid;
}

} // namespace

TEST_CASE("corner cells: a bar of hexahedra and wedges is bent, pins hold and all corners stay positive")
{
    const auto file = bar(test::sized(4, 2));
    const auto parts = file.corner_simplices();
    const auto& m = parts.simplices;
    const rigid_motion<3> turn{.from = vec3(0.5, 0.5, 2), .to = vec3(0.5, 0.5, 2.2), .angle = 1};
    deform_params<tetrahedron> how;
    how.owners = parts.cells;
    how.data.weights = parts.weights;
    how.constraints = constraints(m);
    for (idx v = 0; v < m.vertex_count(); ++v)
    {
        const vec3& p = m.points()[static_cast<std::size_t>(v)];
        if (p.z == 0 || p.z == 2) how.constraints.pin(v, p.z == 0 ? p : turn(p));
    }
    queue q(test::shared_context());
    const auto [x, report] = deform(q, m, how);
    REQUIRE(report.outcome == outcome::valid);
    CHECK(report.pins_held);
    CHECK(report.converged);
    CHECK(report.flips.flipped == 0);
    CHECK(all_valid(file, x));
    for (const auto& [v, pin] : how.constraints.pins()) CHECK(x[static_cast<std::size_t>(v)] == pin.value);

    how.owners.pop_back();
    CHECK_THROWS_WITH_AS(deform(q, m, how), doctest::Contains("owners"), parameter_error);
}

TEST_CASE("corner cells: tangled ones are smoothed to regular ones, and flat sides stay flat")
{
    const auto file = bar(test::sized(4, 3));
    auto parts = file.corner_simplices();
    auto points = file.points;
    std::mt19937 random(6);
    const double size = test::sized(4, 3);
    std::uniform_real_distribution<double> move(-0.6 / size, 0.6 / size);
    for (vec3& p : points)
        if (std::min({p.x, p.y, p.z}) > 0 && std::max({p.x, p.y, p.z / 2}) < 1)
            p += vec3(move(random), move(random), move(random));
    const mesh<tetrahedron> tangled(points, parts.simplices.cells());
    queue q(test::shared_context());
    const auto r = smooth(q, tangled, {.targets = parts.regular, .owners = parts.cells});
    REQUIRE(r);
    CHECK(r.before.worst.mean_ratio < 0);
    CHECK(r.after.worst.mean_ratio > 0.5);
    CHECK(all_valid(file, r.x));
    for (std::size_t v = 0; v < r.x.size(); ++v)
        for (int k = 0; k < 3; ++k)
            if (const double side = file.points[v][k]; side == 0 || side == (k == 2 ? 2 : 1)) CHECK(r.x[v][k] == side);
    CHECK_THROWS_WITH_AS(smooth(q, tangled, {.owners = parts.cells}), doctest::Contains("targets"), parameter_error);
}

TEST_CASE("corner cells: quads among triangles of the plane are bent, on a hierarchy that covers them once")
{
    const auto parts = sheet(test::sized(40, 30)).corner_simplices<triangle>(); // has coarser levels
    const auto& m = parts.simplices;
    const rigid_motion<3> turn{.from = vec3(1, 0.5, 0), .to = vec3(0.9, 0.9, 0), .axis = vec3(0, 0, 1), .angle = 1};
    deform_params<triangle> how;
    how.owners = parts.cells;
    how.data.weights = parts.weights;
    how.constraints = constraints(m);
    for (idx v = 0; v < m.vertex_count(); ++v)
    {
        const vec3& p = m.points()[static_cast<std::size_t>(v)];
        if (p.x == 0 || p.x == 1) how.constraints.pin(v, vec2(p.x == 0 ? p : turn(p)));
    }
    queue q(test::shared_context());
    const auto [x, report] = deform(q, m, how);
    REQUIRE(report.outcome == outcome::valid);
    CHECK(report.pins_held);
    CHECK(report.converged);
    CHECK(report.flips.flipped == 0);
    for (const auto& [v, pin] : how.constraints.pins()) CHECK(x[static_cast<std::size_t>(v)] == pin.value);
}

TEST_CASE("corner cells: tangled quads are smoothed to squares; that they cannot be at rest is said by cell")
{
    const idx n = test::sized(40, 36);
    const auto parts = sheet(n).corner_simplices<triangle>();
    auto points = parts.simplices.points();
    std::mt19937 random(2);
    std::uniform_real_distribution<double> move(-0.6 / n, 0.6 / n);
    for (vec3& p : points)
        if (std::min(p.x, p.y) > 0 && std::max(p.x, p.y) < 1) p += vec3(move(random), move(random), 0);
    queue q(test::shared_context());
    const auto r =
        smooth(q, mesh<triangle>(points, parts.simplices.cells()), {.targets = parts.regular, .owners = parts.cells});
    REQUIRE(r);
    CHECK(r.before.worst.mean_ratio < 0);
    CHECK(r.after.worst.mean_ratio > 0.4);
    REQUIRE(!r.report.notes.empty());
    CHECK(doctest::String(r.report.notes[0].c_str()) == doctest::Contains("corners of cells ("));

    const auto file = bar(2);
    const auto solid = file.corner_simplices();
    auto turned = solid.simplices.points();
    std::swap(turned.front(), turned.back());
    deform_params<tetrahedron> how;
    how.owners = solid.cells;
    CHECK_THROWS_WITH_AS(deform(q, mesh<tetrahedron>(turned, solid.simplices.cells()), how),
                         doctest::Contains("corners of cells ("), mesh_error);
}
