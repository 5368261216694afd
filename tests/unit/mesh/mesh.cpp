// SPDX-License-Identifier: MIT
#include <limits>
#include <string>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/mesh.hpp>

namespace
{

using namespace taut;
using taut::idx;

using cells3 = std::vector<std::array<taut::idx, 3>>;
const std::vector<vec3> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

/// The error of building a mesh from these; the test fails if there is none.
mesh_error error_of(std::vector<vec3> points, cells3 cells)
{
    try
    {
        mesh<triangle>(std::move(points), std::move(cells));
    }
    catch (const mesh_error& e)
    {
        return e;
    }
    FAIL("no error");
    return mesh_error(mesh_error::empty, {}, "");
}

bool contains(const mesh_error& e, const std::string& part)
{
    return std::string(e.what()).find(part) != std::string::npos;
}

} // namespace

TEST_CASE("mesh: keeps points, cells and their order")
{
    const mesh<triangle> m(square, {{2, 3, 0}, {0, 1, 2}});
    CHECK(m.vertex_count() == 4);
    CHECK(m.cell_count() == 2);
    CHECK(m.points() == square);
    CHECK(m.cells()[0] == std::array<taut::idx, 3>{2, 3, 0});
    CHECK(m.rest(0)[1] == vec3(0, 1, 0));
}

TEST_CASE("mesh: no cells is an error")
{
    CHECK(error_of({}, {}).fault() == mesh_error::empty);
    CHECK(error_of(square, {}).fault() == mesh_error::empty);
}

TEST_CASE("mesh: an index out of range is named with its cell")
{
    const auto high = error_of(square, {{0, 1, 2}, {0, 2, 4}});
    CHECK(high.fault() == mesh_error::index_out_of_range);
    CHECK(high.ids() == std::vector<taut::idx>{1, 4});
    CHECK(contains(high, "triangle 1 has vertex 4; there are 4, numbered from 0"));
    const auto low = error_of(square, {{0, -1, 2}});
    CHECK(low.ids() == std::vector<taut::idx>{0, -1});
    CHECK(contains(low, "has vertex -1; there are"));
}

TEST_CASE("mesh: every vertex with a coordinate that is not finite is named")
{
    auto points = square;
    points[1].y = std::numeric_limits<double>::quiet_NaN();
    points[3].z = -std::numeric_limits<double>::infinity();
    const auto e = error_of(points, {{0, 1, 2}});
    CHECK(e.fault() == mesh_error::non_finite);
    CHECK(e.ids() == std::vector<taut::idx>{1, 3});
    CHECK(contains(e, "2 vertices (1, 3)"));
}

TEST_CASE("mesh: cells that repeat a vertex are named")
{
    const auto e = error_of(square, {{0, 1, 2}, {0, 2, 2}, {1, 3, 1}});
    CHECK(e.fault() == mesh_error::repeated_vertex);
    CHECK(e.ids() == std::vector<taut::idx>{1, 2});
}

TEST_CASE("mesh: a long list of ids is cut in the message but not in the data")
{
    cells3 cells(100, {1, 1, 2});
    const auto e = error_of(square, cells);
    CHECK(e.ids().size() == 100);
    CHECK(contains(e, "100 triangles (0, 1, 2, 3, 4, ...)"));
}

TEST_CASE("mesh: tetrahedra are checked alike")
{
    const std::vector<vec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    CHECK(mesh<tetrahedron>(points, {{0, 1, 2, 3}}).cell_count() == 1);
    CHECK_THROWS_WITH_AS(mesh<tetrahedron>(points, {{0, 1, 2, 7}}),
                         "tetrahedron 0 has vertex 7; there are 4, numbered from 0", mesh_error);
    CHECK_THROWS_AS(mesh<tetrahedron>(points, {{0, 1, 2, 1}}), mesh_error);
}
