// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <support/at.hpp>
#include <support/meshes.hpp>
#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/symmetry.hpp>
#include <taut/impl/charts/atlas/symmetry/symmetric_half.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

/// A surface with x >= 0 and its mirror image, joined where x is 0.
mesh<triangle> doubled(const mesh<triangle>& half)
{
    auto points = half.points();
    auto cells = half.cells();
    std::vector<idx> image;
    for (std::size_t v = 0; v < half.points().size(); ++v)
    {
        image.push_back(points[v].x == 0 ? static_cast<idx>(v) : static_cast<idx>(points.size()));
        if (points[v].x != 0) points.push_back(points[v] * vec3(-1, 1, 1));
    }
    for (const auto& [a, b, c] : half.cells()) cells.push_back({image[at(a)], image[at(c)], image[at(b)]});
    return {std::move(points), std::move(cells)};
}

/// The same somewhere else.
mesh<triangle> turned(const mesh<triangle>& m)
{
    const vec3 x = glm::normalize(vec3(3, -1, 2)), y = glm::normalize(glm::cross(x, vec3(0, 0, 1)));
    auto points = m.points();
    for (vec3& p : points) p = vec3(7, -2, 3) + p.x * x + p.y * y + p.z * glm::cross(x, y);
    return {std::move(points), m.cells()};
}

void check_images(const mesh<triangle>& m, const mirror_symmetry& s)
{
    CHECK(glm::length(s.normal) == doctest::Approx(1));
    for (std::size_t v = 0; v < m.points().size(); ++v)
    {
        const vec3& p = m.points()[v];
        const vec3 image = p - 2 * (glm::dot(s.normal, p) - s.offset) * s.normal;
        CHECK(glm::distance(image, m.points()[at(s.vertex[v])]) < 1e-3);
        CHECK(s.vertex[at(s.vertex[v])] == static_cast<idx>(v));
    }
    for (idx c = 0; c < m.cell_count(); ++c)
    {
        CHECK(s.image[at(s.image[at(s.polygon[at(c)])])] == s.polygon[at(c)]);
        for (idx k = 0; k < 3; ++k)
        {
            const idx there = s.corner(m, c, k);
            REQUIRE(there >= 0);
            CHECK(m.cells()[at(there) / 3][at(there) % 3] == s.vertex[at(m.cells()[at(c)][at(k)])]);
            const idx side = s.side[at(3 * c + k)];
            if (side < 0) continue;
            const auto [a, b] = side_vertices(m, 3 * c + k);
            CHECK((side_vertices(m, side) == std::array{s.vertex[at(b)], s.vertex[at(a)]}));
        }
    }
}

/// Two columns of quads on both sides of one that lies across the plane, cut along any diagonals.
struct quads
{
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    std::vector<char> together;

    quads()
    {
        constexpr int rows = 4, columns = 5;
        for (int j = 0; j <= rows; ++j)
            for (int i = 0; i <= columns; ++i) points.emplace_back(i - 2.5, j, 0.1 * j * (i - 2.5) * (i - 2.5));
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i)
            {
                const idx a = j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
                cells.insert(cells.end(), {{a, b, d}, {a, d, c}});
                together.insert(together.end(), {0, 1, 0, 0, 0, 1});
            }
    }
};

} // namespace

TEST_CASE("symmetry: a surface finds its plane wherever it lies")
{
    const auto half = test::bumpy(12);
    for (const auto& m : {doubled(half), turned(doubled(half)), doubled(test::grid(6, 6)), test::octahedron()})
    {
        const auto s = find_symmetry(m, facets(m));
        check_images(m, s);
    }
}

TEST_CASE("symmetry: who has no image is named")
{
    const auto m = turned(doubled(test::bumpy(12)));
    auto points = m.points();
    points[40] += 0.05 * glm::normalize(vec3(1, 2, 3));
    const mesh<triangle> moved(std::move(points), m.cells());
    try
    {
        find_symmetry(moved);
        FAIL("it has none");
    }
    catch (const symmetry_error& e)
    {
        const auto& missing = e.vertices();
        CHECK(missing.size() == 2);
        CHECK(std::find(missing.begin(), missing.end(), 40) != missing.end());
        CHECK(std::string(e.what()).find("2 vertices (40, ") != std::string::npos);
    }

    auto cells = doubled(test::grid(6, 6)).cells();
    const mesh<triangle> grid(doubled(test::grid(6, 6)).points(), cells);
    std::swap(cells[0], cells[1]); // of the first quad: its other diagonal
    cells[0] = {grid.cells()[0][0], grid.cells()[0][1], grid.cells()[1][2]};
    cells[1] = {grid.cells()[0][1], grid.cells()[0][2], grid.cells()[1][2]};
    const mesh<triangle> other(grid.points(), cells);
    try
    {
        find_symmetry(other, facets(other));
        FAIL("it has none");
    }
    catch (const symmetry_error& e)
    {
        CHECK(e.vertices().size() == 6); // of the quad, of which two are on the plane, and of its image
        CHECK(std::string(e.what()).find("edges without a mirror image") != std::string::npos);
    }
}

TEST_CASE("symmetry: polygons and their images may be cut along any diagonals, and may lie across")
{
    const quads q;
    const mesh<triangle> m(q.points, q.cells);
    const auto f = facets(m);
    CHECK_THROWS_AS(find_symmetry(m, f), symmetry_error);
    const auto s = find_symmetry(m, f, q.together);
    check_images(m, s);
    idx across = 0;
    for (idx c = 0; c < m.cell_count(); ++c) across += s.image[at(s.polygon[at(c)])] == s.polygon[at(c)];
    CHECK(across == 2 * 4);

    const impl::symmetric_half half(m, f, s);
    CHECK(half.surface().cell_count() == 2 * (4 * 2 + 4));
    std::vector<char> seams, together;
    atlas_params params;
    params.charts.together = q.together;
    params = half.params(params, seams, together);
    CHECK(std::count(seams.begin(), seams.end(), char(1)) == 3 * 4); // both sides of one border, one of the other
    const auto whole = half.seams(seams);
    CHECK(std::count(whole.begin(), whole.end(), char(1)) == 4 * 4);
    std::set<std::size_t> corners;
    half.for_each_corner(
        [&](std::size_t corner, std::size_t own, bool mirrored)
        {
            corners.insert(corner);
            const auto corner_point = [](const mesh<triangle>& of, std::size_t k)
            { return of.points()[at(of.cells()[k / 3][k % 3])]; };
            const vec3 x = corner_point(m, corner), y = corner_point(half.surface(), own);
            CHECK(glm::distance(x, y * vec3(mirrored ? -1 : 1, 1, 1)) < 1e-12);
        });
    CHECK(corners.size() == 3 * m.cells().size());
}
