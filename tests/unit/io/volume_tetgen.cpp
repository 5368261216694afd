// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <taut/errors.hpp>
#include <taut/impl/files/volume/read_volume.hpp>
#include <taut/impl/files/volume/write_volume.hpp>
#include <taut/volume_file.hpp>

#include "support/temporary_folder.hpp"
#include "support/volume_promises.hpp"
#include "support/volume_texts.hpp"

namespace
{

using namespace taut;
using io::cell_kind;

TEST_CASE("TetGen: nodes, elements and faces, counted from any number; markers and attributes are groups")
{
    const auto s = test::small_volume(false);
    for (const int first : {0, 1, 12})
    {
        const std::string elements = test::tetgen_cells(s, cell_kind::tetrahedron, first);
        const auto read = [&](const std::string& nodes)
        { return io::impl::parse_tetgen(nodes, elements, test::tetgen_cells(s, cell_kind::triangle, first)); };
        const auto file = read(test::tetgen_nodes(s, first));
        CHECK(file.points == s.points);
        CHECK(file.tetrahedra().cells()[1] == std::array<idx, 4>{0, 2, 1, 4});
        CHECK(file.find_group("points:1").vertices == std::vector<idx>{1, 3});
        CHECK(file.find_group("faces:7").vertices == std::vector<idx>{0, 1, 2});
        CHECK(file.find_group("tetrahedra:2").vertices == std::vector<idx>{0, 1, 2, 4});
        CHECK(test::broken_promise(file, read) == "");
    }
}

TEST_CASE("TetGen: boundary markers may be written with a point")
{
    const std::string nodes = "4 3 0 1\n0 0 0 0 0.0\n1 1 0 0 2.0\n2 0 1 0 2.0\n3 0 0 1 -1.0\n";
    const auto file = io::impl::parse_tetgen(nodes, "1 4 0\n0 0 1 2 3\n", "1 1\n0 0 2 1 7.0\n");
    CHECK(file.find_group("points:2").vertices == std::vector<idx>{1, 2});
    CHECK(file.find_group("faces:7").vertices == std::vector<idx>{0, 1, 2});
    CHECK_THROWS_WITH_AS(io::impl::parse_tetgen("1 3 0 1\n0 0 0 0 0.5\n", "0 4 0\n"),
                         doctest::Contains("a boundary marker that is no whole number"), io::io_error);
}

TEST_CASE("TetGen: two dimensions are triangles, as Triangle writes them")
{
    const auto file = io::impl::parse_tetgen("4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n", "2 3 0\n1 1 2 3\n2 1 3 4\n");
    CHECK(file.dimension == 2);
    CHECK(file.triangles().cell_count() == 2);
    CHECK(io::impl::with_points(file, std::vector<vec3>{{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {0, 1, 0}}) ==
          "4 2 0 0\n1 0 0\n2 2 0\n3 1 1\n4 0 1\n");
}

TEST_CASE("TetGen: either name reads and writes all files")
{
    const test::temporary_folder folder;
    const auto s = test::small_volume(false);
    folder.write(folder / "in.node", test::tetgen_nodes(s));
    folder.write(folder / "in.ele", test::tetgen_cells(s, cell_kind::tetrahedron));
    const auto file = io::read_volume_file(folder / "in.ele");
    CHECK(file.companions.size() == 1);
    auto points = file.points;
    points[3].z = 0.125;
    file.write(folder / "out.ele", points);
    CHECK(folder.read(folder / "out.ele") == folder.read(folder / "in.ele"));
    CHECK(io::read_volume_file(folder / "out.node").points == points);
    CHECK(folder.entries() == 4);

    folder.write(folder / "in.face", test::tetgen_cells(s, cell_kind::triangle));
    const auto three = io::read_volume_file(folder / "in.node");
    three.write(folder / "three.node", three.points);
    CHECK(folder.read(folder / "three.face") == folder.read(folder / "in.face"));
    CHECK(folder.read(folder / "three.node") == folder.read(folder / "in.node"));
    CHECK_THROWS_WITH_AS(three.write(folder / "in.ele", points), doctest::Contains("is the input"), io::io_error);
    std::filesystem::remove(folder / "in.ele");
    CHECK_THROWS_AS(io::read_volume_file(folder / "in.node"), io::io_error);
}

TEST_CASE("TetGen: files beside an output that are no part of it are left alone")
{
    const test::temporary_folder folder;
    const auto s = test::small_volume(false);
    folder.write(folder / "in.node", test::tetgen_nodes(s));
    folder.write(folder / "in.ele", test::tetgen_cells(s, cell_kind::tetrahedron));
    const auto file = io::read_volume_file(folder / "in.node");
    const auto refuses = [&](const char* name, const char* other)
    {
        folder.write(folder / other, "mine");
        CHECK_THROWS_WITH_AS(file.write(folder / name, file.points), doctest::Contains(other), io::io_error);
        CHECK(folder.read(folder / other) == "mine");
        std::filesystem::remove(folder / other);
        CHECK(folder.entries() == 2);
    };
    refuses("out.node", "out.ele");
    refuses("out.ele", "out.node");
    refuses("out.node", "out.face");
    refuses("out", "out.node");

    file.write(folder / "out.node", file.points);
    file.write(folder / "out.ele", file.points); // its own
    folder.write(folder / "out.face", "mine");
    CHECK_THROWS_WITH_AS(file.write(folder / "out.node", file.points), doctest::Contains("another mesh"), io::io_error);
    CHECK(folder.read(folder / "out.face") == "mine");
    std::filesystem::remove(folder / "out.face");

    // A link beside it leads to somebody else's, be it there or not.
    const test::temporary_folder elsewhere;
    elsewhere.write(elsewhere / "mine", "mine");
    for (const char* name : {"mine", "none"})
    {
        std::filesystem::remove(folder / "out.ele");
        if (!test::make_link(elsewhere / name, folder / "out.ele")) return;
        CHECK_THROWS_WITH_AS(file.write(folder / "out.node", file.points), doctest::Contains("out.ele"), io::io_error);
    }
    CHECK(elsewhere.read(elsewhere / "mine") == "mine");
    CHECK(elsewhere.entries() == 1);
}

TEST_CASE("TetGen: errors name the file and the line")
{
    const auto s = test::small_volume(false);
    const std::string nodes = test::tetgen_nodes(s);
    const auto refuses = [](const std::string& points, const std::string& elements, const char* message)
    {
        CHECK_THROWS_WITH_AS(io::impl::parse_tetgen(points, elements, {}, "a.node"), doctest::Contains(message),
                             io::io_error);
    };
    refuses("4 5 0 0\n", "0 4 0\n", "a.node, line 1: dimension 5; it must be 2 or 3");
    refuses("0 3 0 0\n", "0 4 0\n", "no points");
    refuses(nodes, "1 10 0\n1 1 2 3 4 1 1 1 1 1 1\n", "a.ele, line 1: 10 corners an element");
    refuses(nodes, "1 4 0\n1 1 2 3 6\n", "a.ele, line 2: no point has the number 6");
    refuses(nodes, "2 4 0\n1 1 2 3 4\n", "the file ends before");
    refuses("2 3 0 0\n1 0 0 0\n1 0 0 1\n", "1 4 0\n", "two points have the number 1");
    refuses("2 3 0 0\n1 0 0 0\n2 0 inf 1\n", "1 4 0\n", "point 1 has a coordinate that is not finite");
}

} // namespace
