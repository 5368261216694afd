// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <taut/errors.hpp>
#include <taut/impl/files/volume/read_volume.hpp>
#include <taut/volume_file.hpp>

#include "support/volume_texts.hpp"

namespace
{

using namespace taut;
using io::volume_format;

std::string exchange(std::string text, const std::string& from, const std::string& to)
{
    return text.replace(text.find(from), from.size(), to);
}

TEST_CASE("VTK, VTU: integers of points and cells are groups by value")
{
    const auto s = test::small_volume(false);
    for (const bool text : {true, false})
        for (const auto& [format, bytes] : {std::pair(volume_format::vtk, test::vtk_text(s, {text}, 3)),
                                            std::pair(volume_format::vtk, test::vtk_text(s, {text}, 5)),
                                            std::pair(volume_format::vtu, test::vtu_text(s, {text}))})
        {
            const auto file = io::impl::parse_volume(bytes, format);
            CHECK(file.find_group("part:7").vertices == std::vector<idx>{0, 1, 2});
            CHECK(file.find_group("part:7").dimension == 2);
            CHECK(file.find_group("part:2").vertices == std::vector<idx>{0, 1, 2, 4});
            CHECK(file.find_group("side:1").vertices == std::vector<idx>{1, 3});
            CHECK(file.find_group("side:1").dimension == 0);
            CHECK(file.notes.empty());
        }

    // By the names of types of a fixed width, as VTK 5.1 files have them.
    const auto wide = test::vtk_text(s, {}, 5);
    for (const auto& [name, fixed] : {std::pair("part int", "part vtktypeint32"), {"part int", "part vtktypeuint32"}})
        CHECK(io::impl::parse_volume(exchange(wide, name, fixed), volume_format::vtk)
                  .find_group("part:7")
                  .vertices.size() == 3);
}

TEST_CASE("VTK: attributes that are not known, or number things, make no groups, which is said")
{
    const auto s = test::small_volume(false);
    const std::string text = test::vtk_text(s, {}, 3);
    const auto file =
        io::impl::parse_volume(exchange(text, "VECTORS push float", "SPECIAL push float"), volume_format::vtk);
    REQUIRE(file.notes.size() == 1);
    CHECK(file.notes[0].find("'SPECIAL'") != std::string::npos);
    CHECK(file.find_group("part:1").vertices.size() == 4);

    test::volume_sample many;
    for (int v = 0; v < 400; ++v)
    {
        many.points.emplace_back(v, 0, 0);
        many.cells.push_back({io::cell_kind::vertex, {v}, v});
    }
    const auto numbered = io::impl::parse_volume(test::vtk_text(many, {}, 3), volume_format::vtk);
    CHECK(numbered.groups.size() == 2); // side:0, side:1
    REQUIRE(numbered.notes.size() == 1);
    CHECK(numbered.notes[0].find("'part' has more than 256 different values") != std::string::npos);
}

TEST_CASE("VTK: lookup tables, scalars without a table and metadata within fields are passed over")
{
    const auto s = test::small_volume(false);
    std::string text = test::vtk_text(s, {}, 3);
    text = exchange(text, "LOOKUP_TABLE default\n", "");
    std::string tensors;
    for (int k = 0; k < 45; ++k) tensors += " 1";
    text = exchange(text, "POINT_DATA 5\n",
                    "LOOKUP_TABLE mine 2\n0 0 0 1\n1 1 1 1\nPOINT_DATA 5\nCOLOR_SCALARS c 1\n0 0.5 1 0 0\n"
                    "TENSORS t float\n" +
                        tensors + "\n");
    text = exchange(text, "side 1 5 int\n",
                    "first 1 1 float\n3\nMETADATA\nINFORMATION 1\nNAME L2 LOCATION x\nDATA 2 0 1\n\nside 1 5 int\n");
    text = exchange(text, "FIELD FieldData 1\nfirst", "FIELD FieldData 2\nfirst");
    const auto file = io::impl::parse_volume(text, volume_format::vtk);
    CHECK(file.notes.empty());
    CHECK(file.find_group("part:1").vertices.size() == 4);
    CHECK(file.find_group("side:1").vertices == std::vector<idx>{1, 3});
}

TEST_CASE("VTK: strings, variants and bits are passed over, before points and behind cells")
{
    const auto s = test::small_volume(false);
    std::string longer(70, 'x'), longest(17000, 'y'); // with lengths in two bytes and in four
    for (const bool text : {true, false})
    {
        const std::string strings =
            text ? "names 1 4 string\none\n\ntwo%20words POINTS 3\n" + longer + "\n\n"
                 : "names 1 4 string\n\xc3one\xc0\x80\x46" + longer + std::string("\x40\0\x42\x68", 4) + longest + "\n";
        const std::string others = std::string("any 1 2 variant\n11 0.5\n13 a%20b\n") +
                                   (text ? "flags 1 9 bit\n1 0 1 0 1 1 1\n0 1\n" : "flags 1 9 bit\n\xae\x80\n");
        std::string bytes =
            exchange(test::vtk_text(s, {text}, 3), "FIELD FieldData 1\n", "FIELD FieldData 4\n" + strings + others);
        bytes = exchange(bytes, "SCALARS part int",
                         "SCALARS on bit 1\nLOOKUP_TABLE default\n" + std::string(text ? "1 0 1\n" : "\xa0\n") +
                             "SCALARS part int");
        const auto file = io::impl::parse_volume(bytes, volume_format::vtk);
        CHECK(file.points.size() == s.points.size());
        CHECK(file.notes.empty());
        CHECK(file.find_group("part:7").vertices == std::vector<idx>{0, 1, 2});
        CHECK(file.find_group("side:1").vertices == std::vector<idx>{1, 3});
    }
}

TEST_CASE("VTU: bits and strings make no groups")
{
    const auto s = test::small_volume(false);
    for (const bool text : {true, false})
        for (const char* const array : {"<DataArray type='Bit' Name='b' format='ascii'>1 0 1</DataArray>",
                                        "<DataArray type=\"String\" Name='s' format='ascii'>65 0</DataArray>"})
        {
            const auto file = io::impl::parse_volume(
                exchange(test::vtu_text(s, {text}), "<PointData>", "<PointData>" + std::string(array)),
                volume_format::vtu);
            CHECK(file.find_group("side:1").vertices == std::vector<idx>{1, 3});
        }
}

TEST_CASE("VTK: voxels and pixels are hexahedra and quads, whose corners run around")
{
    const std::string text = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n"
                             "0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1\nCELLS 2 14\n"
                             "8 0 1 2 3 4 5 6 7\n4 0 1 2 3\nCELL_TYPES 2\n11\n8\n";
    const auto file = io::impl::parse_volume(text, volume_format::vtk);
    REQUIRE(file.cells.size() == 2);
    CHECK(file.cells[0].kind == io::cell_kind::hexahedron);
    CHECK(file.cells[0].corners == std::vector<idx>{0, 1, 3, 2, 4, 5, 7, 6});
    CHECK(file.cells[1].kind == io::cell_kind::quad);
    CHECK(file.cells[1].corners == std::vector<idx>{0, 1, 3, 2});
}

TEST_CASE("VTU: arrays that share their bytes make no more of a file than these")
{
    test::volume_sample many;
    for (int v = 0; v < 400; ++v)
    {
        many.points.emplace_back(v, 0, 0);
        many.cells.push_back({io::cell_kind::vertex, {v}, 1});
    }
    const std::string raw = test::vtu_text(many, {.text = false});
    const auto begin = raw.find("<DataArray type='Int32' Name=\"side\""), end = raw.find("/>", begin) + 2;
    std::string same;
    for (int k = 0; k < 2000; ++k) same += raw.substr(begin, end - begin);
    const auto file = io::impl::parse_volume(exchange(raw, "<PointData>", "<PointData>" + same), volume_format::vtu);
    std::size_t values = 0;
    for (const auto& label : file.labels) values += label.values.size();
    CHECK(values < file.bytes.size());
    REQUIRE_FALSE(file.notes.empty());
    CHECK(file.notes.back().find("so they share them") != std::string::npos);
}

TEST_CASE("VTK: errors tell the line")
{
    const std::string text = test::vtk_text(test::small_volume(false), {}, 3);
    const auto refuses = [](const std::string& bytes, const char* message)
    {
        CHECK_THROWS_WITH_AS(io::impl::parse_volume(bytes, volume_format::vtk, "a.vtk"), doctest::Contains(message),
                             io::io_error);
    };
    refuses("solid", "line 1: not a VTK file");
    refuses(exchange(text, "ASCII", "HEX"), "line 3: neither ASCII nor BINARY");
    refuses(exchange(text, "UNSTRUCTURED_GRID", "POLYDATA"), "line 4: no DATASET UNSTRUCTURED_GRID");
    refuses(exchange(text, "5 double", "5 int"), "points of integers cannot be moved");
    refuses(exchange(text, "5 double", "5 half"), "line 8: unknown type 'half'");
    refuses(exchange(text, "1 1 double", "1 1 half"),
            "no POINTS before 'half', a type of values that is not known; save");
    refuses(exchange(text, "1 1 double\n0.5", "1 99999999 string\n0.5"), "more than the rest of the file can hold");
    refuses(exchange(text, "\n3 0 2 1", "\n3 0 2 9"), "point 9 of 5; they count from 0");
    refuses(exchange(text, "\n3 0 2 1", "\n9 0 2 1"), "has 9 corners");
    refuses(exchange(text, "CELL_TYPES 3\n5", "CELL_TYPES 3\n9"), "cell 0, a quad, ends at corner 3 instead of 4");
    refuses(exchange(text, "CELL_TYPES 3\n5", "CELL_TYPES 3\n42"), "polyhedra cannot be read; split them");
    refuses(exchange(text, "CELL_TYPES 3\n5", "CELL_TYPES 3\n24"),
            "cells of higher order; save the mesh in first order");
    refuses(exchange(text, "CELL_TYPES 3", "CELL_TYPES 2"), "2 cell types for 3 cells");
    refuses(exchange(text, "POINTS 5", "POINTS 50000000"), "more than the rest of the file can hold");
    refuses(exchange(text, "0.001", "inf"), "line 12: point 3 has a coordinate that is not finite");
}

TEST_CASE("VTU: errors tell the line and the remedy")
{
    const auto s = test::small_volume(false);
    const std::string text = test::vtu_text(s, {}), raw = test::vtu_text(s, {.text = false});
    const auto refuses = [](const std::string& bytes, const char* message)
    {
        CHECK_THROWS_WITH_AS(io::impl::parse_volume(bytes, volume_format::vtu, "a.vtu"), doctest::Contains(message),
                             io::io_error);
    };
    refuses("x", "there is no <VTKFile>");
    refuses(exchange(text, "type=\"UnstructuredGrid\"", "type=\"PolyData\""), "line 3: not an UnstructuredGrid");
    refuses(exchange(text, "format=\"ascii\">0 0 0\n", "format=\"binary\">AAAA"), "array 'Points': ");
    refuses(exchange(raw, "encoding=\"raw\"", "encoding=\"base64\""), "array 'Points': ");
    refuses(exchange(raw, "version=\"1.0\" byte", "compressor=\"vtkZLibDataCompressor\" byte"), "array 'Points': ");
    refuses(exchange(raw, "version=\"1.0\" byte", "compressor=\"vtkOwnDataCompressor\" byte"),
            "compressed with vtkOwnDataCompressor, which is not known; save the mesh uncompressed");
    refuses(exchange(text, "</Piece>", "</Piece><Piece NumberOfPoints='0' NumberOfCells='0'></Piece>"),
            "a second piece; merge them");
    refuses(exchange(text, "NumberOfPoints=\"5\"", "NumberOfPoints=\"6\""), "the file ends before a number");
    refuses(exchange(text, "NumberOfPoints=\"5\"", "NumberOfPoints=\"four\""), "no NumberOfPoints");
    refuses(exchange(text, "Name=\"offsets\"", "Name=\"ends\""), "no array offsets in <Cells>");
    refuses(exchange(text, "NumberOfComponents=\"3\"", "NumberOfComponents=\"2\""), "points need three components");
    refuses(exchange(raw, "offset=\"0\"", "offset=\"99999\""), "no offset");
    // The points are bytes 44 to 163 behind the mark, with their number before them.
    refuses(exchange(raw, "<PointData>",
                     "<PointData><DataArray type='Float64' Name='old' NumberOfComponents='3' format='appended' "
                     "offset='40'/>"),
            "line 6: array 'old' has bytes of the points");
    refuses(exchange(text, "\">5 10 10</DataArray>", "\">5 10 42</DataArray>"), "polyhedra");

    // What is wrong with an attribute alone costs its groups.
    const auto file = io::impl::parse_volume(exchange(text, "format=\"ascii\">0 1 0 1 0<", "format=\"zip\">AAAA<"),
                                             volume_format::vtu);
    REQUIRE(file.notes.size() == 1);
    CHECK(file.notes[0].find("no groups were made of 'side': format 'zip'") != std::string::npos);
}

} // namespace
