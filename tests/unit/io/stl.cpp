// SPDX-License-Identifier: MIT
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>
#include <taut/impl/core/mesh/validate.hpp>
#include <taut/impl/files/surface/stl.hpp>
#include <taut/impl/files/surface/surface_formats.hpp>
#include <taut/mesh.hpp>
#include <taut/surface_file.hpp>

namespace
{

using namespace taut;
using io::impl::parse_stl;
using stl_triangle = std::array<vec3, 3>;

std::string text_stl(const std::vector<stl_triangle>& triangles)
{
    std::string text = "solid part of a machine\n";
    for (const auto& t : triangles)
    {
        text += "  facet normal 0 0 1\n    outer loop\n";
        for (const vec3& p : t)
            text +=
                "      vertex " + std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' + std::to_string(p.z) + '\n';
        text += "    endloop\n  endfacet\n";
    }
    return text + "endsolid part of a machine\n";
}

std::string binary_stl(const std::vector<stl_triangle>& triangles, const std::string& title = "made by a test")
{
    std::string bytes = title + std::string(80 - title.size(), ' ');
    const auto add = [&](auto x)
    {
        char to[sizeof x];
        io::impl::store(to, x, std::endian::little);
        bytes.append(to, sizeof x);
    };
    add(static_cast<std::uint32_t>(triangles.size()));
    for (const auto& t : triangles)
    {
        for (int k = 0; k < 3; ++k) add(0.0f);
        for (const vec3& p : t)
            for (int k = 0; k < 3; ++k) add(static_cast<float>(p[k]));
        add(std::uint16_t(0));
    }
    return bytes;
}

/// A torus of n by n quads in two: closed, every edge shared.
std::vector<stl_triangle> stl_torus(int n)
{
    const auto point = [n](int i, int j)
    {
        const double a = 2 * std::acos(-1.0) * (i % n) / n, b = 2 * std::acos(-1.0) * (j % n) / n;
        const auto coarse = [](double x) { return std::round(x * 64) / 64; }; // the same in text and in floats
        return vec3(coarse((3 + std::cos(b)) * std::cos(a)), coarse((3 + std::cos(b)) * std::sin(a)),
                    coarse(std::sin(b)));
    };
    std::vector<stl_triangle> triangles;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
        {
            triangles.push_back({point(i, j), point(i + 1, j), point(i + 1, j + 1)});
            triangles.push_back({point(i, j), point(i + 1, j + 1), point(i, j + 1)});
        }
    return triangles;
}

} // namespace

TEST_CASE("stl: text and binary give the same closed surface, its vertices in the order of first appearance")
{
    const auto triangles = stl_torus(12);
    for (const auto& bytes : {text_stl(triangles), binary_stl(triangles), binary_stl(triangles, "solid of facet")})
    {
        const auto file = parse_stl(bytes);
        REQUIRE(file.surface.cells().size() == triangles.size());
        CHECK(file.surface.vertex_count() == 144);
        CHECK(taut::impl::facets(file.surface).oriented());
        taut::idx seen = 0;
        for (std::size_t c = 0; c < triangles.size(); ++c)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const taut::idx v = file.surface.cells()[c][k];
                CHECK(file.surface.points()[static_cast<std::size_t>(v)] == triangles[c][k]);
                CHECK(v <= seen);
                if (v == seen) ++seen;
            }
        REQUIRE(file.notes.size() == 1);
        CHECK(file.notes[0] == "864 corners of triangles were welded by position to 144 vertices");
    }
}

TEST_CASE("stl: corners that differ in their last bit stay apart, 0 and -0 are one place")
{
    const double next = static_cast<double>(std::nextafter(1.0f, 2.0f));
    const auto file =
        parse_stl(binary_stl({{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{-0.0, 0, 0}, {0, 1, 0}, {next, 0, 0}}}}));
    CHECK(file.surface.cells()[1] == std::array<taut::idx, 3>{0, 2, 3});
    CHECK(file.surface.points()[3].x == next);
}

TEST_CASE("stl: text of several solids, in upper case, without indents and with larger faces is read")
{
    const auto file = parse_stl("SOLID a\r\nFACET NORMAL 0 0 1\r\nOUTER LOOP\r\nVERTEX 0 0 0\r\nVERTEX 1 0 0\r\n"
                                "VERTEX 1 1 0\r\nVERTEX 0 1e0 0\r\nENDLOOP\r\nENDFACET\r\nENDSOLID a\r\nsolid b\r\n"
                                "facet normal nan nan nan\r\nouter loop\r\nvertex 0 0 0\r\nvertex 0 1 0\r\n"
                                "vertex 0 0 +1\r\nendloop\r\nendfacet\r\nendsolid");
    CHECK(file.surface.cell_count() == 3);
    CHECK(file.surface.vertex_count() == 5);
    CHECK(file.notes[0] == "1 polygon was split into triangles");
}

TEST_CASE("stl: bytes behind the last triangle are left out, with a note")
{
    const auto file = parse_stl(binary_stl(stl_torus(3)) + "by a program");
    CHECK(file.surface.cell_count() == 18);
    CHECK(file.notes.back() == "12 bytes behind the last triangle were left out");
}

TEST_CASE("stl: what is cut off, empty or no STL is refused by name")
{
    const auto says = [](const std::string& bytes, const char* what)
    { CHECK_THROWS_WITH_AS(parse_stl(bytes, "x.stl"), doctest::Contains(what), error); };
    const auto binary = binary_stl(stl_torus(3)), text = text_stl(stl_torus(3));
    says("", "x.stl: neither a text nor a binary STL file");
    says(binary.substr(0, 200), "x.stl, byte 80: the file ends too early for 18 triangles");
    says(binary.substr(0, 83), "neither");
    says(binary_stl({}), "no triangles");
    says("solid a\nendsolid a\n", "no triangles");
    says(text.substr(0, text.find("endloop")), "ends in a loop");
    says("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n", "line 6");
    says("solid a\nfacet normal 0 0 1\nvertex 0 0 0\n", "x.stl, line 3: a vertex outside of a loop");
    says("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n", "line 4: expected a number, found 'x'");
    says("solid a\nfacet normal 0 0 1\nouter loop\nouter loop\n", "a loop begins in another one");
    says("solid a\nfacet normal 0 0 1\nendloop\n", "a loop ends that has not begun");
    says("solid a\nfacet normal 0 0 1\npoint 0 0 1\n", "line 3: expected a statement of STL, found 'point'");
    says(binary_stl({{{{0, 0, 0}, {0, 0, 0}, {0, 1, 0}}}}), "1 triangle (0) naming a vertex twice");
    says(binary_stl({{{{0, 0, 0}, {1.0 / 0.0, 0, 0}, {0, 1, 0}}}}), "not a finite number");
}

TEST_CASE("stl: read by the name of the file, by a format that is given, and by its bytes")
{
    const test::temporary_folder folder;
    const auto bytes = binary_stl(stl_torus(4));
    folder.write(folder / "a.STL", bytes);
    folder.write(folder / "a.dat", bytes);
    CHECK(io::read_surface(folder / "a.STL").cell_count() == 32);
    CHECK(io::read_surface(folder / "a.dat", io::surface_format::stl).cell_count() == 32);
    CHECK(io::impl::format_of_text(bytes) == io::surface_format::stl);
    CHECK(io::impl::format_of_text(text_stl(stl_torus(3))) == io::surface_format::stl);
}
