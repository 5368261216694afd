// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/volume_texts.hpp>
#include <taut/errors.hpp>
#include <taut/impl/files/volume/read_volume.hpp>
#include <taut/impl/files/volume/write_volume.hpp>
#include <taut/volume_file.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;
using io::volume_format;

std::vector<long long> label_of_cells(const io::volume_file& file, const char* name)
{
    for (const auto& l : file.labels)
        if (l.of_cells && l.name == name) return l.values;
    return {};
}

std::size_t count_of(const io::volume_file& file, io::cell_kind kind)
{
    std::size_t n = 0;
    for (const auto& block : file.cells) n += block.kind == kind ? block.size() : 0;
    return n;
}

/// Splits the edge that all three cells of the small volume share.
void check_split(const std::string& bytes, volume_format format, const char* label)
{
    const auto file = io::impl::parse_volume(bytes, format);
    subdivision how(static_cast<taut::idx>(file.points.size()));
    how.split({0, 1});
    const auto split = io::impl::subdivided(file, how);
    CHECK(split.format == file.format);
    CHECK(split.path == file.path);
    CHECK(split.dimension == file.dimension);
    CHECK(split.places.single == file.places.single);
    REQUIRE(split.points.size() == file.points.size() + 1);
    for (std::size_t v = 0; v < file.points.size(); ++v) CHECK(split.points[v] == file.points[v]);
    CHECK(split.points.back() == (file.points[0] + file.points[1]) / 2.0);
    CHECK(count_of(split, io::cell_kind::tetrahedron) == 4);
    CHECK(count_of(split, io::cell_kind::triangle) == 2); // between them: it is split, too
    std::vector<long long> twice;
    for (const long long x : label_of_cells(file, label)) twice.insert(twice.end(), 2, x);
    CHECK(!twice.empty());
    CHECK(label_of_cells(split, label) == twice);
    REQUIRE(split.groups.size() == file.groups.size());
    for (const auto& g : file.groups) CHECK(split.find_group(g.name).dimension == g.dimension);
    CHECK(split.notes.size() == file.notes.size() + 1);
    // What it is written as is what it says, with other coordinates, too.
    auto moved = split.points;
    moved.back().z += 0.25;
    const auto again = io::impl::parse_volume(io::impl::with_points(split, moved), format);
    CHECK(again.points == moved);
    CHECK(label_of_cells(again, label) == twice);
}

} // namespace

TEST_CASE("subdivided: cells are split in every format that is written anew, with their labels and groups")
{
    const auto sample = test::small_volume(false);
    check_split(test::medit_text(sample), volume_format::medit, "reference");
    for (const bool text : {true, false})
    {
        check_split(test::gmsh2_text(sample, {.text = text}), volume_format::gmsh, "entity");
        check_split(test::gmsh4_text(sample, {.text = text}), volume_format::gmsh, "physical");
    }
    for (const int version : {2, 5})
        check_split(test::vtk_text(sample, {.order = std::endian::big}, version), volume_format::vtk, "part");
    check_split(test::vtk_text(sample, {.text = false, .order = std::endian::big, .single = true}, 5),
                volume_format::vtk, "part");
    for (const bool text : {true, false})
        check_split(test::vtu_text(sample, {.text = text}), volume_format::vtu, "part");
}

TEST_CASE("subdivided: a problem keeps who is fixed, and its rest shape is split alike")
{
    const auto file =
        io::impl::parse_volume("4 3\n0 0 0\n2 0 0\n0 2 0\n0 0 2\n4 3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 4\n0 1 2 3\n"
                               "2\n1\n3\n",
                               volume_format::problem);
    subdivision how(4);
    how.split({1, 2});
    const auto split = io::impl::subdivided(file, how);
    CHECK(split.cells[0].size() == 2);
    CHECK(split.points.back() == vec3(0.5, 0.5, 0));
    CHECK(split.rest.back() == vec3(1, 1, 0));
    CHECK(split.find_group("fixed").vertices == std::vector<taut::idx>{1, 3});
}

TEST_CASE("subdivided: a new point has the reference that all corners of what it splits have")
{
    const auto file =
        io::impl::parse_volume("MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 5\n1 0 0 5\n0 1 0 6\n0 0 1 0\n"
                               "Corners\n1\n3\nTetrahedra\n1\n1 2 3 4 9\nEnd\n",
                               volume_format::medit);
    subdivision how(4);
    how.split({0, 1});
    how.split({1, 2});
    const auto split = io::impl::subdivided(file, how);
    CHECK(split.find_group("vertices:5").vertices == std::vector<taut::idx>{0, 1, 4});
    CHECK(split.find_group("vertices:0").vertices == std::vector<taut::idx>{3, 5});
    CHECK(split.find_group("corners").vertices == std::vector<taut::idx>{2});
    CHECK(split.find_group("tetrahedra:9").vertices.size() == 6);
}

TEST_CASE("subdivided: formats that are not written anew, and cells that are no simplices, are refused")
{
    const auto mixed = io::impl::parse_volume(test::medit_text(test::small_volume(true)), volume_format::medit);
    CHECK_THROWS_WITH_AS(io::impl::subdivided(mixed, subdivision(static_cast<taut::idx>(mixed.points.size()))),
                         doctest::Contains("triangulate"), io::io_error);
    const auto nodes = io::impl::parse_tetgen("4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n", "1 4 0\n0 0 1 2 3\n");
    CHECK_THROWS_WITH_AS(io::impl::subdivided(nodes, subdivision(4)), doctest::Contains("convert"), io::io_error);
    CHECK_THROWS_AS(io::impl::subdivided(nodes, subdivision(3)), parameter_error);
}
