// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <taut/impl/charts/paste/geodesic_distances.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/mesh.hpp>
#include <taut/paste.hpp>

using namespace taut;
using namespace taut::impl;

namespace
{

region_error::fault_type fault_of(const auto& call)
{
    try
    {
        call();
    }
    catch (const region_error& e)
    {
        return e.fault();
    }
    FAIL("no region_error");
    return region_error::empty;
}

/// The triangles of a grid of n by n quads whose quad is in a set.
std::vector<taut::idx> faces_of_quads(int n, const auto& in)
{
    std::vector<taut::idx> faces;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            if (in(i, j)) faces.insert(faces.end(), {2 * (j * n + i), 2 * (j * n + i) + 1});
    return faces;
}

} // namespace

TEST_CASE("geodesic distances: those of the plane are straight, those of a sphere follow it")
{
    const auto plane = test::grid(40, 40);
    const taut::idx middle = 20 * 41 + 20;
    const auto d = geodesic_distances(plane, vertex_cells(plane), std::array{middle});
    for (taut::idx v = 0; v < plane.vertex_count(); ++v)
    {
        const double exact = glm::distance(plane.points()[std::size_t(v)], plane.points()[std::size_t(middle)]);
        CHECK(d[std::size_t(v)] == doctest::Approx(exact).epsilon(0.02));
    }
    const auto sphere = test::cap(40);
    const auto s = geodesic_distances(sphere, vertex_cells(sphere), std::array<taut::idx, 1>{0});
    CHECK(s.back() == doctest::Approx(std::numbers::pi / 2).epsilon(0.02));
    const auto near = geodesic_distances(sphere, vertex_cells(sphere), std::array<taut::idx, 1>{0}, 0.5);
    CHECK(std::isinf(near.back()));
}

TEST_CASE("geodesic disk: a disk with its place in the surface and its rim")
{
    const auto m = test::bumpy(40);
    const auto r = geodesic_disk(m, 20 * 41 + 20, 0.3);
    CHECK(check(r.surface).empty()); // a disk
    REQUIRE(r.vertices.size() == r.surface.points().size());
    CHECK(std::is_sorted(r.vertices.begin(), r.vertices.end()));
    for (std::size_t v = 0; v < r.vertices.size(); ++v)
        CHECK(r.surface.points()[v] == m.points()[std::size_t(r.vertices[v])]);
    for (std::size_t f = 0; f < r.faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(r.vertices[std::size_t(r.surface.cells()[f][k])] == m.cells()[std::size_t(r.faces[f])][k]);
    REQUIRE(boundary_loops(r.surface).size() == 1);
    CHECK(boundary_loops(r.surface)[0] == r.rim);
}

TEST_CASE("geodesic disk: what is enclosed and smaller is filled, what is no disk is refused")
{
    // A finger on a plane: a radius that reaches its foot all around, but not its tip, takes the tip with it.
    const auto finger = test::rings(60,
                                    [](double r, double a)
                                    {
                                        const double t = std::max(0.0, 0.5 - r) * 6;
                                        const double q = r < 0.5 ? 0.2 * std::min(1.0, r * 10) : 0.2 + (r - 0.5) * 4;
                                        return vec3(q * std::cos(a), q * std::sin(a), t);
                                    });
    const auto side = finger.vertex_count() - 1 - 6 * 60 - 6 * 59 - 6 * 58; // in the plane, not at the end of it
    const auto r = geodesic_disk(finger, side, 3.6);
    CHECK(check(r.surface).empty());
    CHECK(std::binary_search(r.vertices.begin(), r.vertices.end(), 0)); // the tip

    const auto torus = test::torus(24, false);
    CHECK(fault_of([&] { geodesic_disk(torus, 0, 4.0); }) == region_error::several_boundaries);
    CHECK(fault_of([&] { geodesic_disk(torus, 0, 100.0); }) == region_error::no_boundary);
    CHECK(fault_of([&] { geodesic_disk(torus, 0, 1e-9); }) == region_error::empty);
    CHECK(fault_of([&] { geodesic_disk(torus, -1, 1.0); }) == region_error::out_of_range);
    CHECK(fault_of([&] { geodesic_disk(torus, 24 * 24, 1.0); }) == region_error::out_of_range);
    CHECK_THROWS_AS(geodesic_disk(torus, 0, 0.0), parameter_error);
    std::vector<taut::idx> all_but_one(std::size_t(torus.cell_count()) - 1);
    std::iota(all_but_one.begin(), all_but_one.end(), 0);
    CHECK(fault_of([&] { region_of_faces(torus, all_but_one); }) == region_error::handles);
    CHECK_THROWS_AS(geodesic_disk(test::three_on_an_edge(), 0, 2.0), mesh_error);
}

TEST_CASE("region of faces: triangles that are oriented differently are named, both of them")
{
    const auto m = test::grid(4, 4);
    auto cells = m.cells();
    std::swap(cells[9][1], cells[9][2]);
    const mesh<triangle> turned(m.points(), cells);
    try
    {
        region_of_faces(turned, std::array<taut::idx, 1>{0});
        FAIL("a clash is accepted");
    }
    catch (const mesh_error& e)
    {
        CHECK(e.fault() == mesh_error::inconsistent_orientation);
        REQUIRE(e.ids().size() == 2);
        CHECK((e.ids()[0] == 9) != (e.ids()[1] == 9));
        for (const taut::idx f : e.ids())
        {
            const auto& t = cells[static_cast<std::size_t>(f)];
            const auto common = std::count_if(
                t.begin(), t.end(),
                [&](taut::idx v) { return std::find(cells[9].begin(), cells[9].end(), v) != cells[9].end(); });
            CHECK(common >= 2); // a neighbour, or itself
        }
    }
}

TEST_CASE("region of faces: taken as they are, refused with what is wrong")
{
    const int n = 8;
    const auto m = test::grid(n, n);
    const auto square =
        region_of_faces(m, faces_of_quads(n, [](int i, int j) { return i > 1 && i < 5 && j > 2 && j < 6; }));
    CHECK(square.surface.vertex_count() == 16);
    CHECK(square.rim.size() == 12);

    const auto refused = [&](const auto& in) { return fault_of([&] { region_of_faces(m, faces_of_quads(n, in)); }); };
    CHECK(refused([](int, int) { return false; }) == region_error::empty);
    CHECK(refused([](int i, int) { return i == 0 || i == 3; }) == region_error::several_components);
    CHECK(refused([](int i, int j) { return i > 1 && i < 5 && j > 1 && j < 5 && (i != 3 || j != 3); }) ==
          region_error::several_boundaries);
    CHECK(fault_of([&] { region_of_faces(m, std::array<taut::idx, 1>{2 * n * n}); }) == region_error::out_of_range);
    CHECK(refused([](int i, int j) // a ring with a quad missing, whose ends touch at a vertex
                  { return i > 1 && i < 5 && j > 1 && j < 5 && (i != 3 || j != 3) && (i != 2 || j != 2); }) ==
          region_error::pinched);
}

TEST_CASE("region inside a loop: to its left")
{
    const int n = 8;
    const auto m = test::grid(n, n);
    const auto at = [=](int i, int j) { return taut::idx(j * (n + 1) + i); };
    std::vector<taut::idx> loop;
    for (int i = 2; i < 5; ++i) loop.push_back(at(i, 2));
    for (int j = 2; j < 5; ++j) loop.push_back(at(5, j));
    for (int i = 5; i > 2; --i) loop.push_back(at(i, 5));
    for (int j = 5; j > 2; --j) loop.push_back(at(2, j));
    CHECK(region_inside(m, loop).faces.size() == 18);
    std::reverse(loop.begin(), loop.end()); // the other side is a ring
    CHECK(fault_of([&] { region_inside(m, loop); }) == region_error::several_boundaries);
    loop.pop_back();
    CHECK(fault_of([&] { region_inside(m, loop); }) == region_error::not_a_loop);
    // A loop around a torus does not part it.
    const auto torus = test::torus(6, false);
    CHECK(fault_of(
              [&] {
                  region_inside(torus, std::array<taut::idx, 6>{0, 1, 2, 3, 4, 5});
              }) == region_error::not_a_loop);
}
