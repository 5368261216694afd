// SPDX-License-Identifier: MIT
#include <string>

#include <doctest/doctest.h>

#include <taut/errors.hpp>
#include <taut/impl/files/surface/off.hpp>

namespace
{

using namespace taut;
using io::impl::parse_off;
using taut::idx;
using cell = std::array<taut::idx, 3>;

std::size_t line_of_error(const std::string& text)
{
    try
    {
        parse_off(text, "x.off");
    }
    catch (const io::io_error& e)
    {
        REQUIRE(e.place());
        return e.place()->number;
    }
    FAIL("no io_error for: " << text);
    return 0;
}

} // namespace

TEST_CASE("off: plain, with the counts on either line, with and without a header")
{
    const std::string body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for (const char* head : {"OFF\n3 1 0\n", "OFF 3 1 0\n", "3 1 0\n", "OFF\n# made by hand\n3 1 0 # counts\n\n",
                             "OFF\r\n3 1\r\n", "OFF\n3\n1 0\n"})
    {
        const auto f = parse_off(head + body);
        CHECK(f.surface.vertex_count() == 3);
        CHECK(f.surface.points()[1] == vec3(1, 0, 0));
        CHECK(f.surface.cells() == std::vector<cell>{{0, 1, 2}});
        CHECK(f.notes.empty());
    }
}

TEST_CASE("off: colours, normals and comments beside the surface")
{
    const auto plain = std::vector<cell>{{0, 1, 2}};
    CHECK(parse_off("COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n0 1 0 0 0 0 0\n3 0 1 2 0.5 0.5 0.5\n")
              .surface.cells() == plain);
    CHECK(parse_off("NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n").surface.cells() == plain);
    CHECK(parse_off("OFF\n3 1 0\n0 0 0 # a\n\n1 0 0\n# b\n0 1 0\n3  0 1 2 # c").surface.cells() == plain);
}

TEST_CASE("off: STOFF has texture coordinates at the end of the line")
{
    const auto f = parse_off("STOFF\n3 1 0\n0 0 0 0 0\n1 0 0 1 0.5\n0 1 0 0 1\n3 0 1 2\n");
    CHECK(f.vertex_texcoords() == std::vector<vec2>{{0, 0}, {1, 0.5}, {0, 1}});
    const auto g =
        parse_off("STCNOFF\n3 1 0\n0 0 0 0 0 1 1 1 1 1 0 0\n1 0 0 0 0 1 1 1 1 1 1 0.5\n0 1 0 0 0 1 1 1 1 1 0 1\n"
                  "3 0 1 2\n");
    CHECK(g.vertex_texcoords() == f.vertex_texcoords());
}

TEST_CASE("off: polygons are split, with a note")
{
    const auto f = parse_off("OFF\n4 1 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
    CHECK(f.surface.cell_count() == 2);
    CHECK(f.notes.size() == 1);
}

TEST_CASE("off: a comment may follow a number at once")
{
    const auto f = parse_off("OFF#a\n3 1 0#b\n0 0 0#c\n1 0 0 #d\n0 1 0\n3 0 1 2#e\n");
    CHECK(f.surface.cell_count() == 1);
    CHECK(f.vertices.positions[0] == "0 0 0");
    CHECK(f.vertices.comments[2] == "c");
}

TEST_CASE("off: malformed files are refused with the line")
{
    CHECK(line_of_error("ply\n") == 1);
    CHECK(line_of_error("4OFF\n3 1 0\n") == 1);
    CHECK(line_of_error("OFF BINARY\n") == 1);
    CHECK(line_of_error("OFF\n-3 1 0\n") == 2);
    CHECK(line_of_error("OFF\n3 x 0\n") == 2);
    CHECK(line_of_error("OFF\n3 1.5 0\n") == 2);
    CHECK(line_of_error("OFF\n3.0 1 0\n") == 2);
    CHECK(line_of_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2.7\n") == 6);
    CHECK(line_of_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3.2 0 1 2\n") == 6);
    CHECK(line_of_error("NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n") == 4);
    CHECK(line_of_error("COFF\n3 1 0\n0 0 0 0 0 1\n1 0 0\n0 1 0 0 0 1\n3 0 1 2\n") == 4);
    CHECK(line_of_error("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n") == 4);
    CHECK(line_of_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n") == 6);
    CHECK(line_of_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 two\n") == 6);
    CHECK(line_of_error("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n") == 7);
    CHECK(line_of_error("") == 1);
}

TEST_CASE("off: counts that the file cannot hold are refused at once")
{
    CHECK(line_of_error("OFF\n2000000000 1 0\n0 0 0\n") == 3);
    CHECK(line_of_error("OFF\n1 9000000000000000000 0\n0 0 0\n") == 3);
    CHECK(line_of_error("OFF\n1 99999999999999999999999 0\n0 0 0\n") == 2);
    CHECK(line_of_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2000000000 0 1 2\n") == 7);
}

TEST_CASE("off: vertices that are missing or not finite are faults of the mesh")
{
    try
    {
        parse_off("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "x.off");
        FAIL("no error");
    }
    catch (const mesh_error& e)
    {
        CHECK(e.fault() == mesh_error::index_out_of_range);
        CHECK(e.ids() == std::vector<taut::idx>{0, 3});
        CHECK(std::string(e.what()).find("line 6") != std::string::npos);
    }
    CHECK_THROWS_AS(parse_off("OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n"), mesh_error);
    CHECK_THROWS_AS(parse_off("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"), mesh_error);
    CHECK_THROWS_AS(parse_off("OFF\n0 0 0\n"), mesh_error);
}

TEST_CASE("off: binary files are named, and texture coordinates that are no numbers are none")
{
    const std::string binary("OFF BINARY\n\0\0\0\3\0\0\0\1", 19);
    CHECK_THROWS_WITH_AS(io::impl::parse_off(binary, "x.off"),
                         doctest::Contains("x.off, line 1: binary OFF is not read; save it as text"), io::io_error);
    const auto f = io::impl::parse_off("STOFF\n3 1 0\n0 0 0 0 0\n1 0 0 1.#INF 0\n0 1 0 0 1\n3 0 1 2\n", "x.off");
    CHECK(f.texcoords.empty());
    CHECK(f.texcoord_fault == "x.off, line 4: a texture coordinate is not a finite number");
    CHECK(io::impl::parse_off("OFF\n3 1 0\n0 0 1.# a comment\n1 0 0\n0 1 0\n3 0 1 2\n").surface.points()[0].z == 1);
}
