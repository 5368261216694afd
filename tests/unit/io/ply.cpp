// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <string>

#include <doctest/doctest.h>

#include <taut/errors.hpp>
#include <taut/impl/files/surface/ply.hpp>

namespace
{

using namespace taut;
using io::impl::parse_ply;
using taut::idx;
using ply_cell = std::array<taut::idx, 3>;

/// Bytes of a value in the wanted order.
template <class T>
std::string bytes(T value, bool big)
{
    std::string s(reinterpret_cast<const char*>(&value), sizeof value);
    if (big != (std::endian::native == std::endian::big)) std::reverse(s.begin(), s.end());
    return s;
}

const std::string ascii_head = "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 3\nproperty float x\n"
                               "property float y\nproperty float z\nelement face 1\n"
                               "property list uchar int vertex_indices\nend_header\n";

/// A triangle with mixed types, an element and properties to skip, before and after.
std::string binary_file(bool big)
{
    std::string s =
        "ply\nformat binary_" + std::string(big ? "big" : "little") +
        "_endian 1.0\nobj_info x\nelement camera 2\nproperty list ushort double view\nproperty char flag\n"
        "element vertex 3\nproperty double x\nproperty uchar red\nproperty float y\nproperty short z\n"
        "element face 1\nproperty uint id\nproperty list uint ushort vertex_index\nproperty list uchar float "
        "weights\nelement edge 1\nproperty int a\nend_header\n";
    for (int c = 0; c < 2; ++c)
    {
        s += bytes<std::uint16_t>(2, big) + bytes(1.5, big) + bytes(2.5, big) + bytes<std::int8_t>(-1, big);
    }
    for (int v = 0; v < 3; ++v)
        s += bytes(0.1 * v, big) + bytes<std::uint8_t>(200, big) + bytes(0.5f * float(v * v), big) +
             bytes<std::int16_t>(static_cast<std::int16_t>(-300 * v), big);
    s += bytes<std::uint32_t>(4000000000u, big) + bytes<std::uint32_t>(3, big);
    for (const int v : {2, 0, 1}) s += bytes(static_cast<std::uint16_t>(v), big);
    s += bytes<std::uint8_t>(1, big) + bytes(1.0f, big);
    s += bytes<std::int32_t>(7, big);
    return s;
}

io::io_error ply_error_of(const std::string& text)
{
    try
    {
        parse_ply(text, "x.ply");
    }
    catch (const io::io_error& e)
    {
        return e;
    }
    FAIL("no io_error for: " << text);
    return io::io_error("", "");
}

} // namespace

TEST_CASE("ply: ascii")
{
    for (const char* body : {"0 0 0\n1 0 0\n0 1 0.5\n3 0 1 2\n", "0 0 0 1 0 0\n0 1 0.5 3 0 1 2",
                             "0 0 0\r\n1 0 0\r\n0 1 .5\r\n3 0 1 2\r\n"})
    {
        const auto f = parse_ply(ascii_head + body);
        CHECK(f.surface.points()[2] == vec3(0, 1, 0.5));
        CHECK(f.surface.cells() == std::vector<ply_cell>{{0, 1, 2}});
        CHECK(f.texcoords.empty());
    }
}

TEST_CASE("ply: binary of either byte order, any types, with parts to skip")
{
    for (const bool big : {false, true})
    {
        const auto f = parse_ply(binary_file(big));
        CHECK(f.surface.points() == std::vector<vec3>{{0, 0, 0}, {0.1, 0.5, -300}, {0.2, 2, -600}});
        CHECK(f.surface.cells() == std::vector<ply_cell>{{2, 0, 1}});
    }
}

TEST_CASE("ply: lists of a vertex are skipped, and what has no meaning here")
{
    const auto f = parse_ply("ply\nformat ascii 1.0\nelement vertex 3\nproperty list uchar float x\nproperty float y\n"
                             "property list uchar int ids\nproperty float x\nproperty float heat\nproperty float z\n"
                             "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                             "2 8 9 0 0 1 -5 0\n0 0 1 7 2 -6 0\n1 5 1 2 7 7 3 -7 0\n3 0 1 2\n");
    CHECK(f.surface.points() == std::vector<vec3>{{1, 0, 0}, {2, 0, 0}, {3, 1, 0}});
}

TEST_CASE("ply: binary data may follow a header with CR LF, and start with a line end")
{
    std::string head =
        "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 3\r\nproperty uchar x\r\nproperty uchar y\r\n"
        "property uchar z\r\nelement face 1\r\nproperty list uchar uchar vertex_indices\r\nend_header\r\n";
    const auto f = parse_ply(head + std::string("\n\n\n\1\0\0\0\2\0\3\0\1\2", 13));
    CHECK(f.surface.points()[0] == vec3(10, 10, 10));
    CHECK(f.surface.points()[1] == vec3(1, 0, 0));
}

TEST_CASE("ply: texture coordinates of vertices, under each of their names")
{
    for (const auto& [s, t] : {std::pair{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}})
    {
        const auto f =
            parse_ply("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                      "property float " +
                      std::string(s) + "\nproperty float " + t +
                      "\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                      "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 0.5\n3 2 0 1\n");
        CHECK(f.vertex_texcoords() == std::vector<vec2>{{0, 0}, {1, 0}, {0, 0.5}});
    }
}

TEST_CASE("ply: texture coordinates of faces, whose seams show")
{
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
        "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    const auto f = parse_ply(head + "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 1 1 0 1\n");
    CHECK(f.vertex_texcoords() == std::vector<vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    CHECK_THROWS_AS(parse_ply(head + "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 5 5 0 1\n").vertex_texcoords(),
                    io::texcoord_error);
    // The second face has none.
    const auto part = parse_ply(head + "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 0\n");
    CHECK(part.texcoord_cells == std::vector<ply_cell>{{0, 1, 2}, {-1, -1, -1}});
    CHECK(ply_error_of(head + "3 0 1 2 5 0 0 1 0 1\n3 0 2 3 0\n").place().has_value());
}

TEST_CASE("ply: polygons are split, with a note")
{
    const auto f =
        parse_ply("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                  "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                  "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
    CHECK(f.surface.cell_count() == 2);
    CHECK(f.notes.size() == 1);
}

TEST_CASE("ply: an element that stands twice is refused, so that each vertex has what the element says")
{
    const std::string vertices = "property float x\nproperty float y\nproperty float z\n";
    const std::string text = "ply\nformat ascii 1.0\nelement vertex 3\n" + vertices + "element vertex 1\n" + vertices +
                             "property float s\nproperty float t\nelement face 1\n"
                             "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0 0.5 0.5\n"
                             "3 0 1 2\n";
    CHECK(ply_error_of(text).place()->number == 7);
    CHECK_THROWS_WITH_AS(parse_ply(text), doctest::Contains("element vertex is declared twice"), taut::io::io_error);
}

TEST_CASE("ply: malformed headers are refused with the line")
{
    const auto line = [](const std::string& text)
    {
        const auto e = ply_error_of(text);
        REQUIRE(e.place());
        CHECK(e.place()->counted_in == io::file_place::line);
        return e.place()->number;
    };
    CHECK(line("") == 1);
    CHECK(line("OFF\n") == 1);
    CHECK(line("ply\nformat ascii 1.0\n") == 3);
    CHECK(line("ply\nformat utf8 1.0\n") == 2);
    CHECK(line("ply\nproperty float x\n") == 2);
    CHECK(line("ply\nelement vertex 3\nproperty quad x\n") == 3);
    CHECK(line("ply\nelement vertex -3\n") == 2);
    CHECK(line("ply\nelement face 1.9\n") == 2);
    CHECK(line("ply\nelement vertex\n") == 2);
    CHECK(line("ply\nnonsense\n") == 2);
    CHECK(line("ply\nelement vertex 0\nend_header\n") == 4); // no format
    CHECK(line("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n") == 7);
}

TEST_CASE("ply: bodies that are too short or hold nonsense are refused")
{
    CHECK(ply_error_of(ascii_head + "0 0 0\n1 0 0\n0 1 0\n3 0 1\n").place()->number == 15);
    CHECK(ply_error_of(ascii_head + "0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n").place()->number == 12);
    CHECK(ply_error_of(ascii_head + "0 0 0\n1 0 0\n0 1 0\n2 0 1\n").place()->number == 14);
    CHECK(ply_error_of(ascii_head + "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n").place()->number == 14);
    CHECK(ply_error_of(ascii_head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n").place()->number == 14);
    for (const bool big : {false, true})
    {
        const std::string whole = binary_file(big);
        const std::size_t body = whole.find("end_header") + 11;
        for (std::size_t n = body; n < whole.size(); ++n)
        {
            const auto e = ply_error_of(whole.substr(0, n));
            REQUIRE(e.place());
            CHECK(e.place()->counted_in == io::file_place::byte);
            CHECK(e.place()->number >= body);
            CHECK(e.place()->number <= n);
        }
    }
}

TEST_CASE("ply: counts that the file cannot hold are refused at once")
{
    const std::string vertex = "property float x\nproperty float y\nproperty float z\n";
    for (const char* format : {"ascii", "binary_little_endian"})
    {
        const std::string head = "ply\nformat " + std::string(format) + " 1.0\n";
        ply_error_of(head + "element vertex 4000000000\n" + vertex + "end_header\n0 0 0\n");
        ply_error_of(head + "element vertex 9000000000000000000\n" + vertex + "end_header\n0 0 0\n");
        ply_error_of(head + "element junk 9000000000000000000\nproperty list uchar int a\nend_header\n0 0 0\n");
        // Rows without properties take no bytes: skipped, not counted through.
        CHECK_THROWS_AS(parse_ply(head + "element junk 9000000000000000000\nend_header\n"), mesh_error);
    }
    const std::string list =
        "ply\nformat binary_little_endian 1.0\nelement junk 1\nproperty list uint uchar a\nend_header\n";
    ply_error_of(list + "\xff\xff\xff\xff\x01");
}

TEST_CASE("ply: vertices that are missing or not finite are faults of the mesh, and so is no face")
{
    const auto fault = [](const std::string& text)
    {
        try
        {
            parse_ply(text, "x.ply");
        }
        catch (const mesh_error& e)
        {
            return e.fault();
        }
        FAIL("no mesh_error");
        return mesh_error::handles;
    };
    CHECK(fault(ascii_head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n") == mesh_error::index_out_of_range);
    CHECK(fault(ascii_head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n") == mesh_error::index_out_of_range);
    CHECK(fault(ascii_head + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n") == mesh_error::non_finite);
    CHECK(fault("ply\nformat ascii 1.0\nend_header\n") == mesh_error::empty);
}

TEST_CASE("ply: faces may stand before the vertices, and name only what follows")
{
    const std::string head = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
                             "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
                      points = "0 0 0\n1 0 0\n0 1 0\n";
    const auto file = parse_ply(head + "3 0 1 2\n" + points);
    CHECK(file.surface.cells() == std::vector<ply_cell>{{0, 1, 2}});
    CHECK(file.surface.points()[1] == vec3(1, 0, 0));
    CHECK_THROWS_WITH_AS(parse_ply(head + "3 0 1 3\n" + points),
                         doctest::Contains("names vertex 3, but there are 3, counted from 0"), mesh_error);
    CHECK_THROWS_AS(parse_ply(head + "3 0 1 2\n0 0 0\n"), io::io_error);
}

TEST_CASE("ply: triangle strips, text and binary: -1 begins another one, a vertex named twice joins two")
{
    using cells = std::vector<ply_cell>;
    const cells expected{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {5, 6, 7}, {0, 1, 2}};
    const std::vector<int> strips[] = {{0, 1, 2, 3, 4, -1, 5, 6, 7, -1, -1, 3}, {1, 1, 0, 2}};
    for (const std::string_view format : {"ascii", "binary_little_endian", "binary_big_endian"})
    {
        std::string text = "ply\nformat " + std::string(format) +
                           " 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
                           "element tristrips 2\nproperty list int int vertex_indices\nend_header\n";
        const bool ascii = format == "ascii", big = format == "binary_big_endian";
        for (int v = 0; v < 8; ++v)
            for (const int x : {v, v * v, 0})
                text += ascii ? std::to_string(x) + ' ' : bytes(static_cast<float>(x), big);
        for (const auto& strip : strips)
        {
            const auto n = static_cast<int>(strip.size());
            text += ascii ? std::to_string(n) : bytes(n, big);
            for (const int v : strip) text += ascii ? ' ' + std::to_string(v) : bytes(v, big);
            if (ascii) text += '\n';
        }
        CHECK(parse_ply(text).surface.cells() == expected);
    }
}

TEST_CASE("ply: texture coordinates that are no numbers are none, and the file says where")
{
    const auto f = parse_ply("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                             "property float z\nproperty float s\nproperty float t\nelement face 1\n"
                             "property list uchar int vertex_indices\nend_header\n"
                             "0 0 0 0 0\n1 0 0 nan 0\n0 1 0 0 1\n3 0 1 2\n",
                             "x.ply");
    CHECK(f.texcoords.empty());
    CHECK(f.texcoord_fault == "x.ply, line 13: a texture coordinate is not a finite number");
}
