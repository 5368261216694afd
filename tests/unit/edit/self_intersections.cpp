// SPDX-License-Identifier: MIT
#include <array>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <support/edit_meshes.hpp>
#include <taut/impl/charts/paste/self_intersections.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

using pair_of_faces = std::array<taut::idx, 2>;

mesh<triangle> both(const mesh<triangle>& a, const mesh<triangle>& b, const vec3& shift)
{
    auto points = a.points();
    auto cells = a.cells();
    for (const vec3& p : b.points()) points.push_back(p + shift);
    for (auto t : b.cells())
    {
        for (auto& v : t) v += a.vertex_count();
        cells.push_back(t);
    }
    return {std::move(points), std::move(cells)};
}

} // namespace

TEST_CASE("self-intersections: two triangles touch, cross, overlap, or share what they may")
{
    const std::vector<vec3> x{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0.5, 0.5, 0},  {0.5, 0.5, 1}, {1, 0.5, 1},
                              {2, 2, 0}, {1, 1, 0}, {3, 0, 0}, {0.5, 0.5, -1}, {0, 0, 1},     {-1, -1, 0}};
    const std::array<taut::idx, 3> t{0, 1, 2};
    CHECK(triangles_meet(x, t, {3, 4, 5}));         // a corner within
    CHECK(triangles_meet(x, t, {9, 4, 5}));         // through it
    CHECK(triangles_meet(x, t, {7, 4, 5}));         // a corner on an edge
    CHECK_FALSE(triangles_meet(x, t, {4, 5, 10}));  // above
    CHECK(triangles_meet(x, t, {3, 6, 8}));         // overlaps in its plane
    CHECK(triangles_meet(x, {3, 7, 1}, {0, 8, 2})); // within another one in its plane
    // One corner in common.
    CHECK_FALSE(triangles_meet(x, t, {0, 10, 11}));
    CHECK(triangles_meet(x, t, {0, 9, 4}));
    CHECK(triangles_meet(x, t, {0, 3, 10}));
    CHECK(triangles_meet(x, t, {0, 7, 8})); // in its plane
    CHECK_FALSE(triangles_meet(x, t, {1, 8, 6}));
    // An edge in common: folded upon each other, side by side, at an angle.
    CHECK(triangles_meet(x, t, {1, 0, 3}));
    CHECK_FALSE(triangles_meet(x, t, {2, 1, 6}));
    CHECK_FALSE(triangles_meet(x, t, {1, 0, 10}));
    CHECK(triangles_meet(x, t, {0, 2, 1}));
    CHECK(triangles_meet(x, t, {3, 7, 6})); // a line, by its edges
    CHECK_FALSE(triangles_meet(x, {3, 7, 6}, {4, 5, 10}));
}

TEST_CASE("self-intersections: pairs of a surface are those of trying all of them")
{
    CHECK(self_intersections(test::sphere(4)).empty());
    CHECK(self_intersections(test::mushroom(12)).empty());

    const auto m = both(test::sphere(3), test::sphere(2), {0.7, 0.3, 0.2});
    std::vector<pair_of_faces> expected;
    for (taut::idx f = 0; f < m.cell_count(); ++f)
        for (taut::idx g = f + 1; g < m.cell_count(); ++g)
            if (triangles_meet(m.points(), m.cells()[std::size_t(f)], m.cells()[std::size_t(g)]))
                expected.push_back({f, g});
    const auto found = self_intersections(m);
    CHECK(found.size() > 20);
    CHECK(found == expected);
    for (const auto& [f, g] : found) CHECK((f < 512 && g >= 512));
}
