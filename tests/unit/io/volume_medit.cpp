// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <taut/errors.hpp>
#include <taut/impl/files/volume/read_volume.hpp>
#include <taut/impl/files/volume/write_volume.hpp>
#include <taut/volume_file.hpp>

#include "support/volume_texts.hpp"

namespace
{

using namespace taut;

io::volume_file read_medit(const std::string& text)
{
    return io::impl::parse_volume(text, io::volume_format::medit, "a.mesh");
}

TEST_CASE("MEDIT: references and lists of vertices are groups")
{
    const auto file = read_medit(test::medit_text(test::small_volume(true)));
    CHECK(file.find_group("triangles:7").vertices == std::vector<idx>{0, 1, 2});
    CHECK(file.find_group("triangles:7").dimension == 2);
    CHECK(file.find_group("7").name == "triangles:7"); // a number alone
    CHECK(file.find_group("tetrahedra:2").vertices == std::vector<idx>{0, 1, 2, 4});
    CHECK(file.find_group("tetrahedra:2").dimension == 3);
    CHECK(file.find_group("vertices:1").vertices == std::vector<idx>{1, 3, 5, 7, 9, 11, 13, 15});
    CHECK(file.find_group("corners").vertices == std::vector<idx>{0, 2});
    CHECK(file.find_group("prisms:2").vertices.size() == 6);
}

TEST_CASE("MEDIT: a line may hold anything, the vertices come anywhere, unknown sections are passed over")
{
    const auto file = read_medit("MeshVersionFormatted 1 Dimension 3 Tetrahedra 1 1 2 3 4 0 # here\nRidges 1 1\n"
                                 "RequiredVertices 1\n4\nVertices 4 0 0 0 0 1 0 0 0 0 1 0 0 0 0 +1.50 9\nEnd junk");
    CHECK(file.points[3] == vec3(0, 0, 1.5));
    CHECK(file.places.single);
    CHECK(file.tetrahedra().cell_count() == 1);
    CHECK(file.find_group("required_vertices").vertices == std::vector<idx>{3});
}

TEST_CASE("MEDIT: a coordinate with the exponent of Fortran is replaced whole")
{
    const auto file = read_medit("MeshVersionFormatted 2 Dimension 3\nVertices 4\n0 0 0 0\n1D+1 0 0 0\n0 1.5d1 0 0\n"
                                 "0 0 20D-1 0\nTetrahedra 1\n1 2 3 4 0\nEnd\n");
    CHECK(file.points[1].x == 10);
    auto points = file.points;
    for (auto& p : points) p *= 0.5;
    CHECK(read_medit(io::impl::with_points(file, points)).points == points);
}

TEST_CASE("MEDIT: errors tell the line")
{
    const std::string head = "MeshVersionFormatted 2\nDimension 3\n", points = "Vertices\n2\n0 0 0 1\n1 0 0 1\n";
    const auto refuses = [&](const std::string& text, const char* message)
    { CHECK_THROWS_WITH_AS(read_medit(text), doctest::Contains(message), io::io_error); };
    refuses("x", "not a MEDIT mesh");
    refuses("MeshVersionFormatted 2\nDimension 4\nVertices 0\n", "a.mesh, line 2: dimension 4; it must be 2 or 3");
    refuses(head, "no Vertices");
    refuses(head + "Vertices\n-1\n", "line 4: the number of vertices is -1");
    refuses(head + "Vertices\n1000000\n0 0 0 0\n", "more than the rest of the file can hold");
    refuses(head + "Vertices\n1\n0 nan 0 0\n", "line 5: point 0 has a coordinate that is not finite");
    refuses(head + "Vertices\n1\n0 1e999 0 0\n", "point 0 has a coordinate that is not finite");
    refuses(head + points + "Edges\n1\n1 3 0\n", "line 9: point 3 of 2; they count from 1");
    refuses(head + points + "Edges\n1\n0 1 0\n", "point 0 of 2");
    refuses(head + points + "Edges\n1\n1 x 0\n", "expected a vertex, found 'x'");
    refuses(head + points + "TetrahedraP2\n0\n", "cells of higher order (TetrahedraP2); save the mesh in first order");
    refuses("MeshVersionFormatted 2\nDimension 2\nVertices 4\n0 0 0\n1 0 0\n0 1 0\n1 1 0\nTetrahedra 1\n1 2 3 4 0\n",
            "volume cells, but two coordinates a point");
}

} // namespace
