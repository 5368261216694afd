// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>
#include <taut/errors.hpp>
#include <taut/impl/files/file/read_file.hpp>
#include <taut/impl/files/surface/complete_texcoords.hpp>
#include <taut/impl/files/surface/obj.hpp>
#include <taut/impl/files/surface/off.hpp>
#include <taut/impl/files/surface/ply.hpp>
#include <taut/surface_file.hpp>

namespace
{

using namespace taut;
using cells_of_soup = std::vector<std::array<taut::idx, 3>>;

const std::string soup_square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::string text_of(const io::surface_soup& soup, const std::vector<taut::idx>& texcoords, const std::vector<vec2>& uv)
{
    const test::temporary_folder folder;
    io::atomic_file out(folder / "out.obj");
    io::write_obj(out, soup, texcoords, uv);
    out.commit();
    return io::impl::read_file(folder / "out.obj");
}

} // namespace

TEST_CASE("soup: a file without faults is what it is as a surface")
{
    const std::string text = soup_square + "vt 0 0\nvt 1 0\nf 1/1 2/2 3/1 4\nf 1 3 4\n";
    auto soup = io::impl::parse_obj_soup(text);
    const auto file = io::impl::parse_obj(text);
    CHECK_FALSE(soup.fault.has_value());
    CHECK(soup.points == file.surface.points());
    CHECK(soup.triangles == file.surface.cells());
    CHECK(soup.texcoord_cells == file.texcoord_cells);
    CHECK(soup.normals.empty());
    CHECK(soup.notes == file.notes);
    CHECK(io::impl::to_surface_file(std::move(soup), "a.obj").obj.bytes == text);
}

TEST_CASE("soup: what a mesh refuses stays, and the first fault is named with its place")
{
    const auto obj =
        io::impl::parse_obj_soup("v 0 0 0\nv nan 0 0\nv 1 1 0\nf 1 2 3\nf 1 1 2\nf 1 2 9\nf 0 1 -7\n", "a.obj");
    CHECK(obj.points.size() == 3);
    CHECK(obj.triangles == cells_of_soup{{0, 1, 2}, {0, 0, 1}, {0, 1, 8}, {-1, 0, -1}});
    REQUIRE(obj.fault.has_value());
    CHECK(obj.fault->fault() == mesh_error::non_finite);
    CHECK(std::string(obj.fault->what()).starts_with("a.obj, line 2: vertex 1 has"));

    const auto off = io::impl::parse_off_soup("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 inf\n3 0 1 2\n3 0 7 -2\n", "a.off");
    CHECK(off.triangles == cells_of_soup{{0, 1, 2}, {0, -1, -1}});
    CHECK(std::isinf(off.points[2].z));
    CHECK(std::string(off.fault->what()).starts_with("a.off, line 5: vertex 2"));

    const auto ply =
        io::impl::parse_ply_soup("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                 "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                                 "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n");
    CHECK(ply.triangles == cells_of_soup{{0, 1, -1}});
    CHECK(ply.fault->fault() == mesh_error::index_out_of_range);
}

TEST_CASE("soup: texture coordinates that are not there are none")
{
    const auto soup = io::impl::parse_obj_soup(soup_square + "vt 0 0\nf 1/1 2/2 3/-9\n");
    CHECK(soup.texcoord_cells.empty());
    CHECK_FALSE(soup.fault.has_value());
    CHECK_FALSE(soup.texcoord_fault.empty());
}

TEST_CASE("soup: a face of one or two corners is a triangle that names a vertex twice")
{
    const auto soup = io::impl::parse_obj_soup(soup_square + "f 1 2 3\nf 2 3\nf 4\nf\nf 1 3 4\n", "a.obj");
    CHECK(soup.triangles == cells_of_soup{{0, 1, 2}, {1, 2, 2}, {3, 3, 3}, {0, 2, 3}});
    CHECK(soup.faces.sizes == std::vector<taut::idx>{3, 2, 1, 0, 3});
    CHECK(soup.faces.corner(3, 0) == 6);
    REQUIRE(soup.fault.has_value());
    CHECK(soup.fault->fault() == mesh_error::repeated_vertex);
    CHECK(std::string(soup.fault->what()) == "a.obj, line 6: a face needs three corners or more");
    CHECK(soup.notes == std::vector<std::string>{"1 face without corners left out"});
    CHECK(io::impl::parse_off_soup("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n2 0 1\n").triangles ==
          cells_of_soup{{0, 1, 2}, {0, 1, 1}});
}

TEST_CASE("soup: all triangles of a polygon have its corner that cannot be used")
{
    const auto soup = io::impl::parse_obj_soup(soup_square + "v nan 0 0\nf 1 2 9 3 4\nf 1 2 3 5\nf 1 2 3 4\n");
    auto first = soup.triangles;
    REQUIRE(first.size() == 7);
    first.resize(5);
    CHECK(first == cells_of_soup{{8, 2, 3}, {8, 3, 0}, {8, 0, 1}, {4, 0, 1}, {4, 1, 2}});
    CHECK(soup.faces.corner(0, 0) == 2);
}

TEST_CASE("soup: malformed files are refused all the same, files without faces are not")
{
    CHECK_THROWS_AS(io::impl::parse_obj_soup("v 0 0 zero\n"), io::io_error);
    CHECK_THROWS_AS(io::impl::parse_off_soup("OFF\n3 1 0\n0 0 0\n"), io::io_error);
    CHECK(io::impl::parse_obj_soup(soup_square).triangles.empty());
    CHECK_THROWS_AS(io::impl::to_surface_file(io::impl::parse_obj_soup(soup_square), "a.obj"), mesh_error);
}

TEST_CASE("soup: normals are those that faces name, or those of the vertices")
{
    const auto obj = io::impl::parse_obj_soup(soup_square + "vn 0 0 1\nvn 0 oops\nf 1 2 3\nf 1//1 3//-1 4//7\n");
    CHECK(obj.normals.size() == 2);
    CHECK(obj.normals[0] == vec3(0, 0, 1));
    CHECK(std::isnan(obj.normals[1].x));
    CHECK(obj.normal_cells == cells_of_soup{{-1, -1, -1}, {0, 1, -1}});
    CHECK_FALSE(obj.fault.has_value());
    const auto off = io::impl::parse_off_soup("NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 -1\n3 0 1 2\n");
    CHECK(off.normals == std::vector<vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0, -1}});
    CHECK(off.normal_cells.empty());
}

TEST_CASE("soup: a large file, which is read in pieces, holds the same as one that is not")
{
    std::string text = "vn 0 0 1\n";
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) text += "v " + std::to_string(i) + " 0 0\nv " + std::to_string(i) + " 1 0\n";
    for (int i = 1; i + 1 < 2 * n; ++i)
    {
        const bool normals = i > n; // the first pieces have none
        text += 'f';
        for (const int k : {0, 1, 2}) text += ' ' + std::to_string(i + k % 2) + (normals ? "//1" : "");
        text += '\n';
    }
    const auto pieces = io::impl::parse_obj_soup(text);
    CHECK(pieces.obj.pieces.size() > 1);
    const auto whole = io::impl::parse_obj_soup(text + "f 1 2 0\n"); // its fault makes it one
    CHECK(whole.obj.pieces.size() == 1);
    CHECK(pieces.points == whole.points);
    CHECK(pieces.normals == whole.normals);
    REQUIRE(pieces.triangles.size() + 1 == whole.triangles.size());
    CHECK(std::equal(pieces.triangles.begin(), pieces.triangles.end(), whole.triangles.begin()));
    CHECK(std::equal(pieces.normal_cells.begin(), pieces.normal_cells.end(), whole.normal_cells.begin()));
}

TEST_CASE("soup: a file is written back with texture coordinates a corner, or none")
{
    const std::string rest = "v nan 0 0\nvn 0 0 1\n# kept\n";
    const auto soup =
        io::impl::parse_obj_soup(soup_square + rest + "vt 9 9\nf 1/1/1 2//1 3/1 4\nf 1 2/1 5/1/1\nf 1 2 7//1");
    CHECK(text_of(soup, {0, 1, 1, 0, -1, -1, -1, 1, 1, 1}, {{0, 0}, {0.5, 1}}) ==
          soup_square + rest + "vt 0 0\nvt 0.5 1\nf 1/1/1 2/2/1 3/2 4/1\nf 1 2 5//1\nf 1/2 2/2 7/2/1");
    CHECK_THROWS_AS(text_of(soup, {0}, {{0, 0}}), parameter_error);
    CHECK_THROWS_AS(text_of(soup, {0, 1, 1, 0, -1, -1, -1, 1, 1, 1}, {{0, 0}}), parameter_error);

    const auto off = io::impl::parse_off_soup("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 nan\n3 0 1 2\n3 0 1 1\n");
    CHECK(text_of(off, {-1, -1, -1, 0, 0, 0}, {{0, 1}}) ==
          "v 0 0 0\nv 1 0 0\nv 0 1 nan\nvt 0 1\nf 1 2 3\nf 1/1 2/1 2/1\n");
}

TEST_CASE("read_surface_soup: files of each kind, faults and all")
{
    const test::temporary_folder folder;
    folder.write(folder / "a.obj", "v 0 0 0\nf 1 1 1\n");
    folder.write(folder / "b.off", "OFF\n1 1 0\n0 0 0\n3 0 0 4\n");
    CHECK(io::read_surface_soup(folder / "a.obj").triangles == cells_of_soup{{0, 0, 0}});
    CHECK(io::read_surface_soup(folder / "b.off").triangles == cells_of_soup{{0, 0, -1}});
    CHECK_THROWS_AS(io::read_surface_soup(folder / "missing.ply"), io::io_error);
}

TEST_CASE("soup: a face that is written has texture coordinates at all corners or at none")
{
    // A pentagon whose corner 2 lies between 1 and 3, one with a vertex twice, a triangle that was left out.
    const auto soup =
        io::impl::parse_obj_soup("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 1 4 0\nv 0 4 0\nf 1 2 3 4 5\nf 1 2 2 4\nf 1 1 2\n");
    std::vector<taut::idx> texcoords{0, 1, -1, 2, 3, 0, 1, -1, 2, -1, -1, -1};
    std::vector<vec2> uv{{0, 0}, {1, 0}, {1, 4}, {0, 4}};
    io::impl::complete_texcoords(soup.faces, soup.points, texcoords, uv);
    CHECK(texcoords == std::vector<taut::idx>{0, 1, 4, 2, 3, 0, 1, 1, 2, -1, -1, -1});
    CHECK(uv.size() == 5);
    CHECK(uv[4] == vec2(1, 1));
    // Across the start of a face, several in a row.
    texcoords = {-1, 1, 1, 2, -1, -1, 3, -1, -1, -1, -1, -1};
    io::impl::complete_texcoords(soup.faces, soup.points, texcoords, uv);
    CHECK(uv[std::size_t(texcoords[4])].y == doctest::Approx(4 - 4.0 / 6));
    CHECK(uv[std::size_t(texcoords[0])].y == doctest::Approx(4 - 4 * 5.0 / 6));
    CHECK(texcoords[5] == 3); // the only one
    // Nothing is between what is not there.
    const auto broken = io::impl::parse_obj_soup("v 0 0 0\nv nan 0 0\nf 1 2 9 0\n");
    texcoords = {0, -1, -1, 1};
    io::impl::complete_texcoords(broken.faces, broken.points, texcoords, uv);
    CHECK(texcoords == std::vector<taut::idx>{0, 0, 0, 1});
}
