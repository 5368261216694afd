// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <taut/errors.hpp>
#include <taut/impl/files/volume/cell_faces.hpp>
#include <taut/impl/files/volume/read_volume.hpp>
#include <taut/impl/files/volume/write_volume.hpp>
#include <taut/volume_file.hpp>

#include "support/temporary_folder.hpp"
#include "support/volume_texts.hpp"

namespace
{

using namespace taut;
using io::cell_kind;
using io::volume_format;

io::volume_file medit_file(const test::volume_sample& s)
{
    return io::impl::parse_volume(test::medit_text(s), volume_format::medit, "a.mesh");
}

TEST_CASE("groups: found by name, or by a number that one name ends in; else what there is is listed")
{
    io::volume_file file;
    file.path = "a.mesh";
    CHECK_THROWS_WITH_AS(file.find_group("wing"), "a.mesh: no group 'wing'; the file has no groups", io::group_error);
    file.groups = {{"wing", 2, {1}}, {"triangles:3", 2, {2}}, {"tetrahedra:3", 3, {4}}, {"vertices:13", 0, {5}}};
    CHECK(file.find_group("wing").vertices == std::vector<idx>{1});
    CHECK(file.find_group("13").name == "vertices:13");
    CHECK_THROWS_WITH_AS(file.find_group("3"),
                         "a.mesh: several groups end in '3'; there are wing, triangles:3, tetrahedra:3, vertices:13",
                         io::group_error);
    CHECK_THROWS_WITH_AS(file.find_group("wings"), doctest::Contains("no group 'wings'; there are wing, "),
                         io::group_error);
}

TEST_CASE("tetrahedra: the order of corners is mended, by what neighbours have")
{
    auto s = test::small_volume(false);
    const auto tetrahedra = medit_file(s).tetrahedra();
    CHECK(tetrahedra.cell_count() == 2);
    const auto all_positive = [](const mesh<tetrahedron>& m)
    {
        for (idx c = 0; c < m.cell_count(); ++c)
            if (!(tetrahedron::determinant(m.rest(c)) > 0)) return false;
        return true;
    };
    const auto turned = [&](std::vector<idx> cells)
    {
        auto other = s;
        for (const idx c : cells)
        {
            auto& corners = other.cells[static_cast<std::size_t>(c) + 1].corners;
            std::swap(corners[0], corners[1]);
        }
        return medit_file(other);
    };
    CHECK(medit_file(s).turned.empty());
    CHECK(io::impl::describe_turned(medit_file(s)).empty());
    for (const auto& cells : {std::vector<idx>{0}, std::vector<idx>{1}, std::vector<idx>{0, 1}})
    {
        auto file = turned(cells);
        CHECK(file.turned == cells);
        CHECK(all_positive(file.tetrahedra()));
        CHECK(io::impl::check_sides(file).empty());
        CHECK(io::impl::with_points(file, file.points) == file.bytes);
        io::impl::turn_cells(file, cells);
        CHECK(file.turned.empty());
        CHECK_FALSE(all_positive(file.tetrahedra()));
        CHECK(io::impl::check_sides(file).size() == (cells.size() == 1 ? 1 : 0)); // where both are, they agree
    }
    CHECK(io::impl::describe_turned(turned({1})) ==
          "1 cell (1) has its corners in the other order than MEDIT files or neighbours have it");
    CHECK_THROWS_WITH_AS(medit_file(test::small_volume(true)).tetrahedra(),
                         "a.mesh: cell 2 is a pyramid; this takes tetrahedra alone, split it into such", io::io_error);
}

TEST_CASE("corner simplices: each corner of each kind, all positive, with the cell they belong to")
{
    const auto s = test::small_volume(true);
    for (const auto& file : {medit_file(s), io::impl::parse_volume(test::vtk_text(s, {}, 3), volume_format::vtk)})
    {
        const auto corners = file.corner_simplices();
        CHECK(corners.simplices.cell_count() == 2 * 1 + 4 + 6 + 8);
        REQUIRE(corners.cells.size() == 20);
        CHECK(corners.cells.front() == 0); // the triangle that comes first does not count
        CHECK(corners.cells.back() == 4);
        CHECK(corners.overlapping);
        for (std::size_t c = 0; c < corners.cells.size(); ++c) CHECK(glm::determinant(corners.regular[c]) > 0);
        for (idx c = 0; c < corners.simplices.cell_count(); ++c)
            CHECK(tetrahedron::determinant(corners.simplices.rest(c)) > 0);
    }
    CHECK_THROWS_AS(medit_file(test::small_square()).corner_simplices(), mesh_error);
}

TEST_CASE("corner simplices: cells of any kind in the other order are read turned over")
{
    for (const std::size_t kind : {1, 2, 3, 4, 5})
    {
        auto s = test::small_volume(true);
        auto& corners = s.cells[kind].corners;
        if (corners.size() == 6)
            corners = {corners[0], corners[2], corners[1], corners[3], corners[5], corners[4]};
        else if (corners.size() == 8)
            std::rotate(corners.begin(), corners.begin() + 4, corners.end());
        else if (corners.size() == 5)
            std::swap(corners[1], corners[3]);
        else
            std::swap(corners[1], corners[2]);
        for (const auto& file : {medit_file(s), io::impl::parse_volume(test::vtk_text(s, {}, 3), volume_format::vtk)})
        {
            CHECK(file.turned.size() == 1); // whose number MEDIT, which sorts by kind, has otherwise
            const auto simplices = file.corner_simplices().simplices;
            for (idx c = 0; c < simplices.cell_count(); ++c) CHECK(tetrahedron::determinant(simplices.rest(c)) > 0);
        }
    }
}

TEST_CASE("writing: coordinates that stay keep their text, others are the shortest that read back")
{
    const std::string head = "MeshVersionFormatted 2\nDimension 3\nVertices 2\n", tail = "\nTriangles 0\nEnd\n";
    const auto file = io::impl::parse_volume(
        head + "+1.500 -0.0 1e+00 7\n\t.5   2. 0.1000000000000000055\t7 # x" + tail, volume_format::medit);
    CHECK(io::impl::with_points(file, file.points) == file.bytes);
    auto points = file.points;
    points[0].y = 0.0; // another sign
    points[1].x = 1. / 3;
    points[1].y = 1e-300;
    CHECK(io::impl::with_points(file, points) ==
          head + "+1.500 0 1e+00 7\n\t0.3333333333333333   1e-300 0.1000000000000000055\t7 # x" + tail);
}

TEST_CASE("writing: single precision rounds, and says to what")
{
    const auto s = test::small_volume(false);
    auto points = s.points;
    points[1].x = 0.1;
    for (const bool text : {true, false})
    {
        const auto file =
            io::impl::parse_volume(test::vtk_text(s, {.text = text, .single = true}, 3), volume_format::vtk, "a.vtk");
        const auto rounded = file.rounded(points);
        CHECK(rounded[1].x == static_cast<double>(0.1f));
        const auto back = io::impl::parse_volume(io::impl::with_points(file, points), volume_format::vtk);
        CHECK(back.points[1].x == (text ? 0.1 : static_cast<double>(0.1f)));
        CHECK(back.rounded(back.points) == rounded);
        points[1].x = 1e300;
        if (!text) CHECK_THROWS_AS(io::impl::with_points(file, points), parameter_error);
        points[1].x = 0.1;
    }
    const auto twice = io::impl::parse_volume(test::vtk_text(s, {}, 3), volume_format::vtk);
    CHECK(twice.rounded(points) == points);
}

TEST_CASE("writing: what a file cannot hold is refused")
{
    const auto file = medit_file(test::small_volume(false));
    auto points = file.points;
    points[2].y = NAN;
    CHECK_THROWS_WITH_AS(io::impl::with_points(file, points), doctest::Contains("point 2 has a coordinate"),
                         parameter_error);
    points.pop_back();
    CHECK_THROWS_WITH_AS(io::impl::with_points(file, points), doctest::Contains("4 for the 5 of the file"),
                         parameter_error);
    const auto planar = io::impl::parse_volume(test::medit_text(test::small_square(), 2), volume_format::medit);
    points = planar.points;
    points[1].z = 1;
    CHECK_THROWS_WITH_AS(io::impl::with_points(planar, points), doctest::Contains("point 1 has left the plane"),
                         parameter_error);
}

TEST_CASE("writing: no output is an input, nor of another format")
{
    const test::temporary_folder folder;
    const std::string text = test::medit_text(test::small_volume(false));
    folder.write(folder / "in.mesh", text);
    const bool links = test::make_link(folder / "in.mesh", folder / "link.mesh");
    const auto file = io::read_volume_file(folder / "in.mesh");
    for (const char* name : {"in.mesh", links ? "link.mesh" : "in.mesh"})
        CHECK_THROWS_WITH_AS(file.write(folder / name, file.points), doctest::Contains("is the input"), io::io_error);
    CHECK_THROWS_WITH_AS(file.write(folder / "out.vtk", file.points),
                         doctest::Contains("the format of its input, MEDIT"), io::io_error);
    CHECK(folder.entries() == (links ? 2 : 1));
    file.write(folder / "out.mesh", file.points);
    CHECK(folder.read(folder / "out.mesh") == text);
}

} // namespace
