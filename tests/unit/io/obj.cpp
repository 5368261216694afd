// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>

#include <doctest/doctest.h>

#include <support/contains.hpp>
#include <support/meshes.hpp>
#include <taut/errors.hpp>
#include <taut/impl/files/surface/obj.hpp>

namespace
{

using taut::test::contains;
using namespace taut;
using io::impl::parse_obj;
using taut::idx;
using cell = std::array<taut::idx, 3>;

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// What a reader throws for the text, and the line it names.
io::io_error io_error_of(const std::string& text)
{
    try
    {
        parse_obj(text, "x.obj");
    }
    catch (const io::io_error& e)
    {
        return e;
    }
    FAIL("no io_error for: " << text);
    return io::io_error("", "");
}

mesh_error mesh_error_of(const std::string& text)
{
    try
    {
        parse_obj(text, "x.obj");
    }
    catch (const mesh_error& e)
    {
        return e;
    }
    FAIL("no mesh_error for: " << text);
    return mesh_error(mesh_error::empty, {}, "");
}

} // namespace

TEST_CASE("obj: vertices and triangles in the order of the file")
{
    const auto f = parse_obj("# a comment\no square\n" + square + "v 9 9 9\ns off\nf 3 1 2\nf 1 3 4\n");
    CHECK(f.surface.vertex_count() == 5); // the unreferenced one too
    CHECK(f.surface.points()[2] == vec3(1, 1, 0));
    CHECK(f.surface.cells() == std::vector<cell>{{2, 0, 1}, {0, 2, 3}});
    CHECK(f.texcoords.empty());
    CHECK(f.texcoord_cells.empty());
    REQUIRE(f.notes.size() == 1);
    CHECK(f.notes[0] == "1 vertex (4) without a triangle: ignored");
}

TEST_CASE("obj: every way to write a corner")
{
    const std::string head = square + "vt 0.25 0.5\nvt 1 0\nvt 0 1\nvn 0 0 1\n";
    for (const char* face : {"f 1 2 3\n", "f 1//1 2//1 3//1\n", "f -4 -3 -2\n", "f 1// 2// 3//\n", "f 1/ 2/ 3/\n",
                             "f\t1  2\t 3 \r\n", "f 1 2 3", "f +1 2 3"})
    {
        const auto f = parse_obj(head + face);
        CHECK(f.surface.cells() == std::vector<cell>{{0, 1, 2}});
        CHECK(f.texcoord_cells == std::vector<cell>{{-1, -1, -1}}); // there are three, but no face names one
    }
    for (const char* face : {"f 1/1 2/2 3/3\n", "f 1/1/1 2/2/1 3/3/1\n", "f 1/-3 2/-2 3/-1\n", "f 1/1/ 2/2/ 3/3/\n"})
    {
        const auto f = parse_obj(head + face);
        CHECK(f.surface.cells() == std::vector<cell>{{0, 1, 2}});
        REQUIRE(f.texcoords.size() == 3);
        CHECK(f.texcoords[0] == vec2(0.25, 0.5));
        CHECK(f.texcoord_cells == std::vector<cell>{{0, 1, 2}});
    }
}

TEST_CASE("obj: negative numbers count from the vertices read so far")
{
    const auto f = parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -2 -3 -1\n");
    CHECK(f.surface.cells() == std::vector<cell>{{0, 1, 2}, {2, 1, 3}});
}

TEST_CASE("obj: faces may come before their vertices")
{
    CHECK(parse_obj("f 1 2 3\n" + square).surface.cells() == std::vector<cell>{{0, 1, 2}});
}

TEST_CASE("obj: line ends, joined lines, byte order mark, colours and homogeneous weights")
{
    const std::vector<cell> expected = {{0, 1, 2}};
    CHECK(parse_obj("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n").surface.cells() == expected);
    CHECK(parse_obj("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r").surface.cells() == expected);
    CHECK(parse_obj("\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3").surface.cells() == expected);
    CHECK(parse_obj("v 0 0 \\\n0\nv 1 0 0\nv 0 1 0\nf 1 \\\r\n 2 \\\n3\n").surface.cells() == expected);
    // A comment ends with its line even so.
    CHECK(parse_obj("# c:\\\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").surface.vertex_count() == 3);
    const auto coloured = parse_obj("v 0 0 0 1 0.5 0\nv 1 0 0 1 1 1\nv 0 1 0 1.0\nf 1 2 3\n");
    CHECK(coloured.surface.points()[1] == vec3(1, 0, 0));
}

TEST_CASE("obj: comments behind any statement, and lines joined right behind a word")
{
    const std::vector<cell> expected = {{0, 1, 2}};
    CHECK(parse_obj("v 0 0 0 # a\nv 1 0 0 #b\nv 0 1 0\nf 1 2 3 # c 4\n").surface.cells() == expected);
    CHECK(parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 # u\nf 1/1 2/1 3/1 #").surface.cells() == expected);
    CHECK(parse_obj("v\\\n0 0 0\\\r\nv 1 0 0\nv 1 0\\\r0\nv 0 1 0\nf 1 2\\\n3\n").surface.cells() == expected);
}

TEST_CASE("obj: digits beyond the range of numbers")
{
    const auto x_of = [](const std::string& digits)
    { return parse_obj("v " + digits + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").surface.points()[0].x; };
    const std::string zeros(400, '0');
    CHECK(x_of('1' + zeros + "e-400") == 1);
    CHECK(x_of("0." + zeros + "1e401") == 1);
    CHECK(x_of("0." + zeros + "1") == 0);
    CHECK(x_of("1e-99999999999999999999") == 0);
    CHECK(x_of("0e99999") == 0);
    for (const std::string& large : {'1' + zeros + "e-5", '-' + ('1' + zeros), "0." + zeros + "1e999",
                                     std::string("1e99999999999999999999"), std::string("4e9223372036854775807")})
        CHECK(mesh_error_of("v " + large + " 0 0\n").fault() == mesh_error::non_finite);
}

TEST_CASE("obj: numbers are read to the last bit, at any magnitude")
{
    const auto p = parse_obj("v 0.1 -1e-3 +2.5E+2\nv 1e-400 4.9406564584124654e-324 .5\n"
                             "v 123456789.123456789 0.30000000000000004 -0\nf 1 2 3\n")
                       .surface.points();
    CHECK(p[0] == vec3(0.1, -1e-3, 250.0));
    CHECK(p[1] == vec3(0.0, 4.9406564584124654e-324, 0.5));
    CHECK(p[2] == vec3(123456789.123456789, 0.1 + 0.2, 0.0));
    CHECK(std::signbit(p[2].z));
}

TEST_CASE("obj: numbers of any count of digits are the doubles nearest to them")
{
    const std::string digits = "98765432109876543210987654321";
    for (std::size_t n = 1; n < digits.size(); ++n)
        for (std::size_t point = 1; point <= n; ++point)
        {
            const std::string number = digits.substr(0, point) + '.' + digits.substr(point, n - point);
            const auto p =
                parse_obj("v -" + number + ' ' + number + " 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").surface.points();
            CAPTURE(number);
            CHECK(p[0].y == std::stod(number));
            CHECK(p[0].x == -std::stod(number));
        }
}

TEST_CASE("obj: a quad is cut along its shorter inner diagonal")
{
    const auto f = parse_obj("v 0 0 0\nv 1 0 0\nv 3 3 0\nv 0 1 0\nf 1 2 3 4\n");
    REQUIRE(f.surface.cell_count() == 2);
    for (const auto& t : f.surface.cells()) // both have the diagonal 1-3
        CHECK((std::find(t.begin(), t.end(), 1) != t.end() && std::find(t.begin(), t.end(), 3) != t.end()));
    REQUIRE(f.notes.size() == 1);
    CHECK(contains(f.notes[0], "1 polygon was split"));

    // An arrow head: the shorter diagonal 1-3 is outside.
    const auto arrow = parse_obj("v 0 0 0\nv 5 -1 0\nv 4 0 0\nv 5 1 0\nf 1 2 3 4\n");
    for (const auto& t : arrow.surface.cells())
        CHECK((std::find(t.begin(), t.end(), 0) != t.end() && std::find(t.begin(), t.end(), 2) != t.end()));
}

TEST_CASE("obj: polygons of any shape and plane are covered once, facing as they did")
{
    // A comb with reflex corners and corners on straight lines, in several planes and both orientations.
    const std::vector<vec2> comb = {{0, 0}, {2.9, 0}, {3, 0.5}, {3.1, 0}, {6, 0}, {6, 4}, {5, 4}, {5, 1},
                                    {4, 1}, {4, 4},   {2, 4},   {2, 1},   {1, 1}, {1, 4}, {0, 4}, {0, 2}};
    const double area = 24 - 2 * 3 * 1 - 0.5 * 0.2 * 0.5;
    for (const auto& [u, v] : {std::pair{vec3(1, 0, 0), vec3(0, 1, 0)},
                               {vec3(0, 1, 0), vec3(1, 0, 0)},
                               {vec3(0, 0.6, 0.8), vec3(-1, 0, 0)},
                               {vec3(0.6, 0, -0.8), vec3(0, 1, 0)}})
    {
        std::string text, face = "f";
        for (std::size_t i = 0; i < comb.size(); ++i)
        {
            const vec3 p = comb[i].x * u + comb[i].y * v;
            text += "v " + std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' + std::to_string(p.z) + '\n';
            face += ' ' + std::to_string(i + 1);
        }
        const auto m = parse_obj(text + face + '\n').surface;
        REQUIRE(m.cell_count() == 14);
        const vec3 normal = glm::cross(u, v);
        double sum = 0;
        for (taut::idx c = 0; c < m.cell_count(); ++c)
        {
            const auto x = m.rest(c);
            const double a = 0.5 * glm::dot(glm::cross(x[1] - x[0], x[2] - x[0]), normal);
            CHECK(a > 1e-9);
            sum += a;
        }
        CHECK(sum == doctest::Approx(area));
    }
}

TEST_CASE("obj: a very large polygon becomes a fan, with a note")
{
    const auto star = [](int n, double inner) // every other corner is that far from the middle
    {
        std::string text, face = "f";
        for (int i = 0; i < n; ++i)
        {
            const double radius = i % 2 == 0 ? 1 : inner, angle = 2 * std::numbers::pi * i / n;
            text += "v " + std::to_string(radius * std::cos(angle)) + ' ' + std::to_string(radius * std::sin(angle)) +
                    " 0\n";
            face += ' ' + std::to_string(i + 1);
        }
        return text + face;
    };
    const auto large = parse_obj(star(4400, 0.5));
    CHECK(large.surface.cell_count() == 4398);
    REQUIRE(large.notes.size() == 2);
    CHECK(contains(large.notes[0], "(1 as a fan, too large for more)"));
    CHECK(
        contains(large.notes[1], "1 polygon is concave, and fan triangulation from the first corner flips triangles"));
    for (const auto& text : {star(4400, 1), star(600, 0.5)}) // few reflex corners take few steps
    {
        const auto ears = parse_obj(text);
        CHECK_FALSE(contains(ears.notes[0], "fan"));
    }
}

TEST_CASE("obj: a polygon that is not convex is cut as a fan from its first corner where that covers it")
{
    const std::string dented = "v 0 0 0\nv 10 -1 0\nv 11 -0.5 0\nv 10.5 0 0\nv 11 0.5 0\nv 10 1 0\n";
    const auto at_first = [](const auto& f) {
        return std::ranges::all_of(f.surface.cells(),
                                   [](const auto& t) { return t[0] == 0 || t[1] == 0 || t[2] == 0; });
    };
    const auto whole = parse_obj(dented + "f 1 2 3 4 5 6\n");
    CHECK(whole.surface.cell_count() == 4);
    CHECK(at_first(whole)); // the shortest diagonal is from corner 2 to 4
    CHECK(whole.notes.size() == 1);
    // From corner 3 the dent hides the other side.
    const auto hidden = parse_obj(dented + "f 3 4 5 6 1 2\n");
    CHECK(hidden.surface.cell_count() == 4);
    REQUIRE(hidden.notes.size() == 2);
    CHECK(contains(hidden.notes[1], "1 polygon is concave, and fan triangulation"));
}

TEST_CASE("obj: texture coordinates of polygons follow their corners")
{
    const auto f = parse_obj(square + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/4 2/3 3/2 4/1\n");
    REQUIRE(f.texcoord_cells.size() == 2);
    for (std::size_t c = 0; c < 2; ++c)
        for (std::size_t k = 0; k < 3; ++k) CHECK(f.texcoord_cells[c][k] == 3 - f.surface.cells()[c][k]);
}

TEST_CASE("obj: texture coordinates by vertex, or the vertex on a seam is named")
{
    const std::string head = square + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 1 1\nvt 7 7\n";
    const auto good = parse_obj(head + "f 1/1 2/2 3/3\nf 1/1 3/5 4/4\n").vertex_texcoords(); // 3 and 5 are equal
    CHECK(good == std::vector<vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}});

    const auto vertex_of = [](const io::surface_file& f)
    {
        try
        {
            f.vertex_texcoords();
        }
        catch (const io::texcoord_error& e)
        {
            return e.vertex();
        }
        return taut::idx(-1);
    };
    CHECK(vertex_of(parse_obj(head + "f 1/1 2/2 3/3\nf 1/1 3/6 4/4\n")) == 2);
    CHECK(vertex_of(parse_obj(head + "f 1/1 2/2 3/3\nf 1/1 3/3 4\n")) == 3);
    CHECK(vertex_of(parse_obj(square + "f 1 2 3\n")) == 0);
}

TEST_CASE("obj: malformed lines are named")
{
    const auto line = [](const std::string& text)
    {
        const auto e = io_error_of(text);
        CHECK(e.path() == "x.obj");
        REQUIRE(e.place());
        CHECK(e.place()->counted_in == io::file_place::line);
        return e.place()->number;
    };
    CHECK(line("v 0 0\n") == 1);
    CHECK(line("v 0 0 0\nv 1 zero 0\n") == 2);
    CHECK(line("v 0 0 0\r\n\r\nv 1 0 0x\r\n") == 3);
    CHECK(line("v 1 2 1.#\n") == 1);
    CHECK(line("v 1 2 1.#qnan\n") == 1);
    CHECK(line(square + "f 1 2\n") == 5);
    CHECK(line(square + "f\n") == 5);
    CHECK(line(square + "f 0 1 2\n") == 5);
    CHECK(line(square + "f 1 2 -5\n") == 5);
    CHECK(line(square + "f 1 2 3a\n") == 5);
    CHECK(line(square + "f 1 2 +-3\n") == 5);
    CHECK(line("v 0 0 +-1\n") == 1);
    CHECK(line(square + "f 1 2 3.5\n") == 5);
    CHECK(line(square + "f 1/x 2 3\n") == 5);
    CHECK(line(square + "f 1/1/1/1 2 3\n") == 5);
    CHECK(line(square + "f 1 2 99999999999\n") == 5);
    CHECK(line(square + "f 1 2 99999999999999999999999\n") == 5);
    CHECK(line(square + "vt zero 0\n") == 5);
    CHECK(contains(io_error_of("v 0 0 0\nv 1 zero 0\n").what(), "x.obj, line 2: expected a number, found 'zero'"));
    CHECK(contains(io_error_of("v 0 0\n").what(), "found the end of the line"));
    CHECK_FALSE(io_error_of(std::string("v 0 0 0\n\0\x01", 10)).place().has_value());
}

TEST_CASE("obj: a coordinate that is no finite number names vertex and line")
{
    for (const char* bad : {"nan", "inf", "-inf", "NaN", "1e999", "-nan", "1.#INF", "-1.#IND00", "1.#QNAN", "-1.#J"})
    {
        const auto e = mesh_error_of("v 0 0 0\n# gap\nv 1 " + std::string(bad) + " 0\n");
        CHECK(e.fault() == mesh_error::non_finite);
        CHECK(e.ids() == std::vector<taut::idx>{1});
        CHECK(contains(e.what(), "x.obj, line 3: vertex 1"));
    }
}

TEST_CASE("obj: a face that names a missing vertex is found with its line")
{
    const auto e = mesh_error_of(square + "f 1 2 3\nf 1 2 7\nf 1 3 4\n");
    CHECK(e.fault() == mesh_error::index_out_of_range);
    CHECK(e.ids() == std::vector<taut::idx>{1, 6});
    CHECK(contains(e.what(), "x.obj, line 6"));
}

TEST_CASE("obj: names end with their line, though a backslash may end them; what has numbers goes on")
{
    const std::string names = "mtllib a\\\ng b \\\no c\\\ns 1\\\nusemtl d\\\n# e \\\nunknown \\\n";
    for (const char* end : {"\n", "\r\n"})
    {
        std::string text = names + square + names + "f 1 2 \\\n3\nl 1 \\\nv 9 9 9\n";
        for (std::size_t at = 0; *end == '\r' && (at = text.find('\n', at)) != text.npos; at += 2)
            text.insert(at, "\r");
        const auto file = parse_obj(text);
        CHECK(file.surface.vertex_count() == 4);
        CHECK(file.surface.cells() == std::vector<std::array<taut::idx, 3>>{{0, 1, 2}});
    }
}

TEST_CASE("obj: texture coordinates that cannot be used are none, and the file says why")
{
    const std::string good = "vt 0 0\nvt 1 0\nvt 1 1\n", face = "f 1/1 2/2 3/3\n";
    for (const auto& [text, reason] :
         {std::pair(square + "vt nan 0\n" + good + face, "x.obj, line 5: a texture coordinate is not a finite number"),
          {square + good + "vt 0 -1.#INF\n" + face, "x.obj, line 8: a texture coordinate is not a finite number"},
          {square + good + face + "f 1/1 3/3 4/4\n",
           "x.obj, line 9: a face names texture coordinate 4, but there are 3"},
          {square + good + face + "f 1/1 3/3 4/-7\n", "x.obj, line 9: a face names number -7 of 3"},
          {square + good + face + "f 1/1 3/3 4/0\n", "x.obj, line 9: a face names number 0 of 3"},
          {square + face, "x.obj, line 5: a face names texture coordinate 3, but there are 0"}})
    {
        const auto file = parse_obj(text, "x.obj");
        CHECK(file.texcoords.empty());
        CHECK(file.texcoord_cells.empty());
        CHECK(file.texcoord_fault.starts_with(reason));
        REQUIRE_FALSE(file.notes.empty());
        CHECK(file.notes[0] == "the texture coordinates of the file are not used: " + file.texcoord_fault);
        const auto soup = io::impl::parse_obj_soup(text, "x.obj");
        CHECK_FALSE(soup.fault.has_value());
        CHECK(soup.texcoord_fault == file.texcoord_fault);
    }
    CHECK(parse_obj(square + good + face).texcoord_fault.empty());
}

TEST_CASE("obj: nothing to read is an empty mesh; other faults of meshes name the file")
{
    CHECK(mesh_error_of("").fault() == mesh_error::empty);
    CHECK(mesh_error_of("# nothing\n").fault() == mesh_error::empty);
    CHECK(mesh_error_of(square).fault() == mesh_error::empty);
    const auto e = mesh_error_of(square + "f 1 1 2\n");
    CHECK(e.fault() == mesh_error::repeated_vertex);
    CHECK(e.ids() == std::vector<taut::idx>{0});
    CHECK(contains(e.what(), "x.obj"));
}

TEST_CASE("obj: a large file, which is read in pieces, holds the same as its lines")
{
    // Grids of unit squares; vertices and faces in every manner of writing them.
    const auto m = test::grid(90, 90);
    const auto text_of = [&](const std::string& end, bool relative)
    {
        std::string text = "\xef\xbb\xbf# a grid" + end;
        for (std::size_t v = 0; v < m.points().size(); ++v)
        {
            const vec3& p = m.points()[v];
            text += "v " + std::to_string(p.x) + ' ' + std::to_string(p.y) + (v % 7 ? " 0" : " \\" + end + "-0.0e0");
            text += (v % 5 ? "" : " 0.5 " + std::to_string(v) + " 1") + end;
        }
        for (const auto& t : m.cells())
        {
            text += 'f';
            for (const taut::idx v : t)
                text += (v % 11 ? " " : " \\" + end) + std::to_string(relative ? v - m.vertex_count() : v + 1);
            text += end + "p 1 \\" + end + "f 1 1 1" + end;
        }
        return text;
    };
    for (const std::string end : {"\n", "\r\n", "\r"})
        for (const bool relative : {false, true})
        {
            const auto text = text_of(end, relative);
            REQUIRE(text.size() > 4 << 16);
            const auto file = parse_obj(text);
            CHECK(file.surface.cells() == m.cells());
            REQUIRE(file.surface.points().size() == m.points().size());
            for (std::size_t v = 0; v < m.points().size(); ++v)
                CHECK(std::abs(file.surface.points()[v].x - m.points()[v].x) < 1e-6);
        }

    // Faults are found in their place, however far behind.
    std::string text = text_of("\n", false);
    const auto line = std::to_string(std::count(text.begin(), text.end(), '\n') + 1);
    CHECK(contains(io_error_of(text + "f 1 2 x\n").what(), "x.obj, line " + line));
    const auto e = mesh_error_of(text + "f 1 2 99999\nf 1 3 2\n");
    CHECK(e.ids() == std::vector<taut::idx>{m.cell_count(), 99998});
    CHECK(contains(e.what(), "x.obj, line " + line));
}

TEST_CASE("obj: numbers are the doubles nearest to what is written")
{
    std::mt19937_64 rng(4);
    for (int i = 0; i < 4000; ++i)
    {
        // Up to 18 digits, a point anywhere or nowhere.
        std::string digits = std::to_string(rng() >> (rng() % 60 + 4));
        if (i % 3) digits.insert(rng() % digits.size() + 1, 1, '.');
        if (i % 5 == 0) digits = '-' + digits;
        if (i % 7 == 0) digits += "e-5";
        const auto file = parse_obj("v " + digits + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        CHECK_MESSAGE(file.surface.points()[0].x == std::strtod(digits.c_str(), nullptr), digits);
    }
}
