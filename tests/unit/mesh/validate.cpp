// SPDX-License-Identifier: MIT
#include <algorithm>
#include <random>
#include <string>

#include <doctest/doctest.h>

#include <support/contains.hpp>
#include <support/meshes.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>

namespace
{

using taut::test::contains;
using namespace taut;
using taut::idx;

std::vector<mesh_error::fault_type> faults(const std::vector<taut::mesh_finding>& found)
{
    std::vector<mesh_error::fault_type> r;
    for (const auto& f : found) r.push_back(f.fault);
    return r;
}

/// The only finding of check(); the test fails if there are more or none.
template <class Element>
taut::mesh_finding only_finding(const mesh<Element>& m)
{
    const auto found = check(m);
    REQUIRE(found.size() == 1);
    return found[0];
}

using ids = std::vector<taut::idx>;

} // namespace

TEST_CASE("validate: disks of every kind pass")
{
    CHECK_NOTHROW(validate(test::single_triangle()));
    CHECK_NOTHROW(validate(test::grid(4, 3)));
    CHECK_NOTHROW(validate(test::flat_disk(7)));
    CHECK_NOTHROW(validate(test::cap(7)));
    CHECK_NOTHROW(validate(test::cap(9, 3.0)));
    CHECK_NOTHROW(validate(test::tube(16, 10)));
    CHECK_NOTHROW(validate(test::fan(9)));
    CHECK_NOTHROW(validate(test::fan(9, true)));
    for (std::uint32_t seed = 0; seed < 5; ++seed) CHECK_NOTHROW(validate(test::bumpy(15, 0.2, seed)));
}

TEST_CASE("validate: throws the first finding with fault, ids and remedy")
{
    try
    {
        validate(test::octahedron());
        FAIL("no error");
    }
    catch (const mesh_error& e)
    {
        CHECK(e.fault() == mesh_error::closed_surface);
        CHECK(e.ids().empty());
        CHECK(contains(e.what(), "cut it open along a seam"));
    }
}

TEST_CASE("validate: flat triangles are named, slivers pass")
{
    const std::vector<std::array<taut::idx, 3>> cells = {{0, 1, 2}, {0, 2, 3}};
    const auto with_height = [&](double h) {
        return mesh<triangle>({{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}, {0, 1, 0}}, cells);
    };
    CHECK(check(with_height(1e-9)).empty());
    CHECK(check(with_height(1e-13)).empty());
    for (const double h : {0.0, 1e-15})
    {
        const auto f = only_finding(with_height(h));
        CHECK(f.fault == mesh_error::degenerate_cell);
        CHECK(f.ids == ids{0});
    }
    // Two vertices at one place.
    const auto f = only_finding(mesh<triangle>({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, cells));
    CHECK(f.ids == ids{0});
    // All vertices at one place, and away from the origin.
    CHECK(only_finding(mesh<triangle>(std::vector<vec3>(4, vec3(5.0)), cells)).ids == ids{0, 1});
}

TEST_CASE("validate: the scale of the mesh does not matter")
{
    for (const double s : {1e-300, 1e-160, 1e-30, 1e30, 1e160, 1e300})
    {
        auto points = test::bumpy(6).points();
        for (vec3& p : points) p *= s;
        CHECK(check(mesh<triangle>(points, test::bumpy(6).cells())).empty());
    }
}

TEST_CASE("validate: duplicate triangles are named in pairs")
{
    for (const taut::idx original : {4, 8}) // at the boundary and inside, its corners in three orders
        for (std::size_t turn = 0; turn < 3; ++turn)
        {
            auto cells = test::grid(3, 3).cells();
            const auto c = cells[static_cast<std::size_t>(original)];
            cells.push_back({c[turn], c[(turn + 1) % 3], c[(turn + 2) % 3]});
            const auto found = check(mesh<triangle>(test::grid(3, 3).points(), cells));
            REQUIRE(!found.empty());
            CHECK(found[0].fault == mesh_error::duplicate_cell);
            CHECK(found[0].ids == ids{original, 18});
        }

    // A pillow: the copy is turned over, and every edge looks as it should.
    const auto pillow = check(mesh<triangle>(test::single_triangle().points(), {{0, 1, 2}, {0, 2, 1}}));
    REQUIRE(!pillow.empty());
    CHECK(pillow[0].fault == mesh_error::duplicate_cell);
    CHECK(pillow[0].ids == ids{0, 1});

    // The copy of a lone triangle clashes on every edge, but it is a duplicate.
    const auto twice = check(mesh<triangle>(test::single_triangle().points(), {{0, 1, 2}, {1, 2, 0}}));
    CHECK(faults(twice) == std::vector{mesh_error::duplicate_cell});
}

TEST_CASE("validate: triangles that are turned over are named in pairs")
{
    auto cells = test::grid(3, 3).cells();
    std::swap(cells[0][0], cells[0][1]); // a corner triangle with one neighbour
    const auto f = only_finding(mesh<triangle>(test::grid(3, 3).points(), cells));
    CHECK(f.fault == mesh_error::inconsistent_orientation);
    REQUIRE(!f.ids.empty());
    CHECK(f.ids.size() % 2 == 0);
    CHECK(std::find(f.ids.begin(), f.ids.end(), 0) != f.ids.end());
    CHECK(contains(f.message, "turn one of each over"));
}

TEST_CASE("validate: a Moebius strip cannot be oriented")
{
    const auto f = only_finding(test::moebius(8));
    CHECK(f.fault == mesh_error::not_orientable);
    CHECK(f.ids.size() == 2);
    CHECK(contains(f.message, "cut the mesh open"));
}

TEST_CASE("validate: an edge with three triangles is named by its vertices")
{
    const auto f = only_finding(test::three_on_an_edge());
    CHECK(f.fault == mesh_error::non_manifold_facet);
    REQUIRE(f.ids.size() == 2);
    CHECK(std::min(f.ids[0], f.ids[1]) == 0);
    CHECK(std::max(f.ids[0], f.ids[1]) == 1);
    CHECK(contains(f.message, "1 edge (0-1) with three or more triangles"));
}

TEST_CASE("validate: a vertex where two parts touch is named")
{
    const auto f = only_finding(test::bowtie());
    CHECK(f.fault == mesh_error::non_manifold_vertex);
    CHECK(f.ids == ids{2});
}

TEST_CASE("validate: unreferenced vertices are named, and may be allowed")
{
    auto points = test::grid(2, 2).points();
    points.insert(points.begin(), vec3(9.0));
    points.push_back(vec3(8.0));
    auto cells = test::grid(2, 2).cells();
    for (auto& t : cells)
        for (auto& v : t) ++v;
    const mesh<triangle> m(points, cells);
    const auto f = only_finding(m);
    CHECK(f.fault == mesh_error::unreferenced_vertex);
    CHECK(f.ids == ids{0, 10});
    CHECK_NOTHROW(validate(m, {.referenced = false}));
}

TEST_CASE("validate: several components are named by a vertex of each")
{
    const auto f = only_finding(test::two_components());
    CHECK(f.fault == mesh_error::several_components);
    CHECK(f.ids == ids{0, 9});
    CHECK(check(test::two_components(), {.connected = false}).empty());
}

TEST_CASE("validate: several boundary loops are named by a vertex of each")
{
    const auto f = only_finding(test::annulus(6));
    CHECK(f.fault == mesh_error::several_boundaries);
    CHECK(f.ids == ids{0, 1});
    CHECK(check(test::annulus(6), {.one_boundary = false}).empty());
}

TEST_CASE("validate: a closed surface and a handle are not a disk")
{
    CHECK(only_finding(test::octahedron()).fault == mesh_error::closed_surface);
    CHECK(check(test::octahedron(), {.open = false}).empty());
    CHECK(only_finding(test::torus(5, true)).fault == mesh_error::handles);
    CHECK(check(test::torus(5, true), {.no_handles = false}).empty());
    CHECK(faults(check(test::torus(5, false))) == std::vector{mesh_error::closed_surface, mesh_error::handles});
}

TEST_CASE("check: several faults are all found")
{
    // A grid with a turned triangle, a flat one, a loose vertex and a second component.
    auto points = test::grid(2, 2).points();
    auto cells = test::grid(2, 2).cells();
    std::swap(cells[0][0], cells[0][1]);
    points[4] = points[8];
    points.insert(points.end(), {{5, 5, 5}, {6, 0, 0}, {7, 0, 0}, {6, 1, 0}});
    cells.push_back({10, 11, 12});
    const auto found = check(mesh<triangle>(points, cells));
    CHECK(faults(found) == std::vector{mesh_error::degenerate_cell, mesh_error::inconsistent_orientation,
                                       mesh_error::unreferenced_vertex, mesh_error::several_components});
}

TEST_CASE("validate: volumes pass, and inverted, flat or touching tetrahedra are named")
{
    CHECK(check(test::cube(3)).empty());
    CHECK(check(test::single_tetrahedron()).empty());

    auto cells = test::cube(2).cells();
    std::swap(cells[5][0], cells[5][1]);
    const auto found = check(mesh<tetrahedron>(test::cube(2).points(), cells));
    REQUIRE(found.size() == 2);
    CHECK(found[0].fault == mesh_error::inverted_cell);
    CHECK(found[0].ids == ids{5});
    CHECK(found[1].fault == mesh_error::inconsistent_orientation);

    const auto flat = only_finding(mesh<tetrahedron>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2, 3}}));
    CHECK(flat.fault == mesh_error::degenerate_cell);

    // Two tetrahedra on a common edge are not a solid.
    const auto hinge = only_finding(mesh<tetrahedron>(
        {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0.5, 0.5, 0}, {-1, 0, 0}, {-0.5, -0.5, 0}}, {{0, 2, 3, 1}, {0, 4, 5, 1}}));
    CHECK(hinge.fault == mesh_error::non_manifold_vertex);
    CHECK(hinge.ids == ids{0, 1});

    // Three tetrahedra on a face.
    const auto crowd = check(mesh<tetrahedron>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {0.3, 0.3, 2}},
                                               {{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}}));
    CHECK(faults(crowd) == std::vector{mesh_error::non_manifold_facet});
    CHECK(crowd[0].ids.size() == 3);
}

TEST_CASE("validate: the order of vertices and cells does not matter")
{
    std::mt19937 rng(5);
    const auto m = test::bumpy(10);
    auto cells = m.cells();
    std::shuffle(cells.begin(), cells.end(), rng);
    for (auto& t : cells) std::rotate(t.begin(), t.begin() + rng() % 3, t.end());
    CHECK_NOTHROW(validate(mesh<triangle>(m.points(), cells)));
}
