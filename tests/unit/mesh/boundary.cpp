// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/mesh.hpp>

namespace
{

using namespace taut;
using taut::idx;

double signed_area(const mesh<triangle>& m, const std::vector<taut::idx>& loop)
{
    double twice = 0;
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
        const vec3 a = m.points()[static_cast<std::size_t>(loop[i])];
        const vec3 b = m.points()[static_cast<std::size_t>(loop[(i + 1) % loop.size()])];
        twice += a.x * b.y - a.y * b.x;
    }
    return twice / 2;
}

} // namespace

TEST_CASE("boundary: one triangle is its own loop")
{
    const auto loops = boundary_loops(test::single_triangle());
    REQUIRE(loops.size() == 1);
    CHECK(loops[0] == std::vector<taut::idx>{0, 1, 2});
}

TEST_CASE("boundary: a counter-clockwise disk has a counter-clockwise loop, the interior on the left")
{
    const auto m = test::grid(5, 4);
    const auto loops = boundary_loops(m);
    REQUIRE(loops.size() == 1);
    CHECK(loops[0].size() == 18);
    CHECK(loops[0][0] == 0);
    CHECK(loops[0][1] == 1);
    CHECK(signed_area(m, loops[0]) == doctest::Approx(1.0));
    CHECK(signed_area(test::flat_disk(6), boundary_loops(test::flat_disk(6))[0]) > 0);
}

TEST_CASE("boundary: turning every triangle over turns the loop")
{
    const auto m = test::grid(3, 3);
    auto cells = m.cells();
    for (auto& t : cells) std::swap(t[1], t[2]);
    const mesh<triangle> turned(m.points(), cells);
    CHECK(signed_area(turned, boundary_loops(turned)[0]) == doctest::Approx(-1.0));
}

TEST_CASE("boundary: the hole of an annulus runs clockwise")
{
    const auto m = test::annulus(16);
    const auto loops = boundary_loops(m);
    REQUIRE(loops.size() == 2);
    CHECK(loops[0][0] == 0); // inner radius
    CHECK(loops[1][0] == 1); // outer radius
    CHECK(signed_area(m, loops[0]) < 0);
    CHECK(signed_area(m, loops[1]) > 0);
    CHECK(loops[0].size() == 16);
}

TEST_CASE("boundary: a closed surface has no loops")
{
    CHECK(boundary_loops(test::octahedron()).empty());
    CHECK(boundary_loops(test::torus(4, false)).empty());
    CHECK(boundary_loops(test::torus(4, true)).size() == 1);
}

TEST_CASE("boundary: parts that touch in a vertex keep their own loops")
{
    const auto loops = boundary_loops(test::bowtie());
    REQUIRE(loops.size() == 2);
    CHECK(loops[0] == std::vector<taut::idx>{0, 1, 2});
    CHECK(loops[1] == std::vector<taut::idx>{2, 3, 4});
}

TEST_CASE("boundary: where left has no meaning the error says so")
{
    CHECK_THROWS_AS(boundary_loops(test::three_on_an_edge()), mesh_error);
    CHECK_THROWS_AS(boundary_loops(test::moebius(5)), mesh_error);
}

TEST_CASE("boundary: the faces of a volume point out and close up")
{
    const auto m = test::cube(3);
    const auto faces = taut::impl::boundary_facets(m);
    CHECK(faces.size() == 6 * 9 * 2);
    double volume = 0; // divergence theorem
    for (const auto& f : faces)
    {
        const auto x = [&](int k) { return m.points()[static_cast<std::size_t>(f[static_cast<std::size_t>(k)])]; };
        volume += glm::dot(x(0), glm::cross(x(1), x(2))) / 6;
    }
    CHECK(volume == doctest::Approx(1.0));
    CHECK(boundary_loops(mesh<triangle>(m.points(), faces)).empty());
}
