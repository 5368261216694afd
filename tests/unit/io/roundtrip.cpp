// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/temporary_folder.hpp>
#include <taut/impl/files/surface/obj.hpp>
#include <taut/surface_file.hpp>

using namespace taut;
using test::temporary_folder;

namespace
{

/// uv = (number of the vertex, -1).
std::vector<vec2> numbered(std::size_t n)
{
    std::vector<vec2> uv;
    for (std::size_t v = 0; v < n; ++v) uv.emplace_back(static_cast<double>(v), -1);
    return uv;
}

/// What write_obj makes of a file with these bytes.
std::string rewritten(const std::string& name, const std::string& bytes)
{
    const temporary_folder folder;
    folder.write(folder / name, bytes);
    const auto file = io::read_surface_file(folder / name);
    io::write_obj(folder / "out.obj", file, numbered(file.surface.points().size()));
    const auto back = io::read_surface_file(folder / "out.obj");
    CHECK(back.surface.points() == file.surface.points());
    CHECK(back.surface.cells() == file.surface.cells());
    CHECK(back.texcoord_cells == back.surface.cells());
    return folder.read(folder / "out.obj");
}

} // namespace

TEST_CASE("write_obj: of an OBJ everything stays but vt and the texture coordinates of faces")
{
    CHECK(
        rewritten("a.obj", "# by hand\r\nmtllib chair.mtl\r\no seat\r\nv  0.00 0 +0 1 0 0\r\nv\t1.0e0 0 0 # right\r\n"
                           "v 1 1 0\r\nv 0 1 0\r\nvn 0 0 1\r\nvt 7 7\r\nvt 8 8 8\r\ng top\r\nusemtl wood\r\ns 1\r\n"
                           "f 4/1/1 3/2/1 -3/-1/-1 1/2/1 # turned\r\n\r\nl 1 2\r\n# end") ==
        "# by hand\r\nmtllib chair.mtl\r\no seat\r\nv  0.00 0 +0 1 0 0\r\nv\t1.0e0 0 0 # right\r\n"
        "v 1 1 0\r\nv 0 1 0\r\nvn 0 0 1\r\nvt 0 -1\r\nvt 1 -1\r\nvt 2 -1\r\nvt 3 -1\r\ng top\r\nusemtl wood\r\ns 1\r\n"
        "f 4/4/1 3/3/1 -3/2/-1 1/1/1 # turned\r\n\r\nl 1 2\r\n# end");
}

TEST_CASE("write_obj: every way to write corners and lines")
{
    const std::string head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\n", vt = "vt 0 -1\nvt 1 -1\nvt 2 -1\n";
    CHECK(rewritten("a.obj", head + "f 1 2 3") == head + vt + "f 1/1 2/2 3/3");
    CHECK(rewritten("a.obj", head + "  f  -3//1\t-2//1 -1//-1 \n") == head + vt + "  f  -3/1/1\t-2/2/1 -1/3/-1 \n");
    CHECK(rewritten("a.obj", head + "vt 0 0\nf 1/1 2/ 3// \n") == head + vt + "f 1/1 2/2 3/3/ \n");
    CHECK(rewritten("a.obj", head + "f 1 2\\\n 3\n") == head + vt + "f 1/1 2/2\\\n 3/3\n");
    CHECK(rewritten("a.obj", head + "vt 0 \\\n0\nf 1 2 3\n vt 1 1\n#\nvt 5") == head + vt + "f 1/1 2/2 3/3\n#\n");
    CHECK(rewritten("a.obj", "\xef\xbb\xbf"
                             "f 1 2 3\r"
                             "v 0 0 0\r"
                             "v 1 0 0\r"
                             "v 0 1 0\r") == "\xef\xbb\xbf"
                                             "vt 0 -1\rvt 1 -1\rvt 2 -1\rf 1/1 2/2 3/3\rv 0 0 0\rv 1 0 0\rv 0 1 0\r");
    // A backslash joins lines, here behind a position.
    const std::string joined = "v 0 0 0 c\\\nv 1 0 0\nv 1 0 0\nv 0 1 0\n";
    CHECK(rewritten("a.obj", joined + "f 1 2 3\n") == joined + vt + "f 1/1 2/2 3/3\n");
}

TEST_CASE("write_obj: a large OBJ, which is written in pieces, keeps its lines")
{
    const auto m = test::grid(70, 70);
    std::string head, faces, expected, vt;
    for (std::size_t v = 0; v < m.points().size(); ++v)
    {
        head += "v " + std::to_string(m.points()[v].x) + ' ' + std::to_string(m.points()[v].y) + " 0 0.5 0.5 0.5\n";
        vt += "vt " + std::to_string(v) + " -1\n";
    }
    for (std::size_t c = 0; c < m.cells().size(); ++c)
    {
        const std::string group = c % 100 != 50 ? "" : "usemtl m" + std::to_string(c) + '\n';
        faces += group + 'f', expected += group + 'f';
        for (const taut::idx v : m.cells()[c])
        {
            faces += ' ' + std::to_string(v + 1);
            expected += ' ' + std::to_string(v + 1) + '/' + std::to_string(v + 1);
        }
        faces += '\n', expected += '\n';
    }
    REQUIRE(faces.size() > 2 << 16);
    CHECK((rewritten("a.obj", head + faces) == head + vt + expected)); // too long to print
    CHECK((rewritten("a.obj", faces + head) == vt + expected + head));
}

TEST_CASE("write_obj: OFF becomes OBJ with its numbers, colours, normals, polygons and comments")
{
    CHECK(rewritten("a.off", "OFF # a\n#b\n4 1 0\n0.00 0 0\n1e0 0 0 # c\n1 1 0\n0 1 0\n4 3 0 1 2 0.5 0.5 0.5\n") ==
          "# a\n# b\n# c\nv 0.00 0 0\nv 1e0 0 0\nv 1 1 0\nv 0 1 0\nvt 0 -1\nvt 1 -1\nvt 2 -1\nvt 3 -1\nf 4/4 1/1 2/2 "
          "3/3\n");
    CHECK(rewritten("a.off",
                    "STCNOFF\n3 1\n0 0 0 0 0 1 255 0 51 255 0 0\n1 0 0 0 1 0 0 0 0 1 0 0\n0 1 0 nan 0 1 0 0 0 1 1 1\n"
                    "3 0 1 2\n") ==
          "v 0 0 0 1 0 0.2\nv 1 0 0 0 0 0\nv 0 1 0 0 0 0\nvn 0 0 1\nvn 0 1 0\nvn 0 0 1\nvt 0 -1\nvt 1 -1\nvt 2 -1\n"
          "f 1/1/1 2/2/2 3/3/3\n");
    CHECK(rewritten("a.off", "COFF\n3 1\n0 0 0 1 0 0.25\n1 0 0 0 1 0\n0 1 0 0 0 1\n3 0 1 2\n")
              .starts_with("v 0 0 0 1 0 0.25\n"));
}

TEST_CASE("write_obj: PLY becomes OBJ with its numbers, colours, normals, polygons and comments")
{
    const std::string head =
        "comment made by hand\nelement vertex 4\nproperty double x\nproperty uchar red\nproperty uchar green\n"
        "property uchar blue\nproperty double y\nproperty double z\nproperty float nx\nproperty float ny\n"
        "property float nz\nelement face 1\nproperty list uchar int vertex_index\nend_header\n";
    const std::string rest = "vn 0 0 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\nvt 0 -1\nvt 1 -1\nvt 2 -1\nvt 3 -1\n"
                             "f 1/1/1 2/2/2 3/3/3 4/4/4\n";
    CHECK(rewritten(
              "a.ply",
              "ply\nformat ascii 1.0\n" + head +
                  "0.10 255 0 51 0 0 0 0 1\n1 0 0 0 0 0 0 0 1\n1 0 0 0 1 0 0 0 1\n0 0 0 0 1 0 0 0 1\n4 0 1 2 3\n") ==
          "# made by hand\nv 0.10 0 0 1 0 0.2\nv 1 0 0 0 0 0\nv 1 1 0 0 0 0\nv 0 1 0 0 0 0\n" + rest);
}

TEST_CASE("write_obj: one texture coordinate a vertex of the file is required")
{
    const temporary_folder folder;
    const auto file = io::impl::parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    CHECK_THROWS_AS(io::write_obj(folder / "x.obj", file, numbered(2)), parameter_error);
    CHECK(folder.entries() == 0);
}

TEST_CASE("cut_seams: a vertex for each texture coordinate that its corners have")
{
    const std::string head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
    // Vertices 1 and 2 lie on a seam; one vt a corner is none.
    const std::string text = head + "vt 0 0\nvt 1 0\nvt 0 1\nvt 5 0\nvt 6 1\nvt 5 1\nf 1/1 2/2 3/3\nf 2/4 4/5 3/6\n";
    const auto file = io::impl::parse_obj(text);
    const auto cut = file.cut_seams().value();
    CHECK(cut.surface.cells() == std::vector<std::array<taut::idx, 3>>{{0, 1, 2}, {4, 3, 5}});
    CHECK(cut.surface.points()[5] == vec3(0, 1, 0));
    CHECK(cut.origins == std::vector<taut::idx>{0, 1, 2, 3, 1, 2});
    CHECK(cut.uv == std::vector<vec2>{{0, 0}, {1, 0}, {0, 1}, {6, 1}, {5, 0}, {5, 1}});
    CHECK(cut.seam_vertices == 2);
    CHECK_FALSE(io::impl::parse_obj(head + "vt 0 0\nvt 1 0\nvt 0 1\nvt 1 0\nvt 1 1\nvt -0 1\n"
                                           "f 1/1 2/2 3/3\nf 2/4 4/5 3/6\n")
                    .cut_seams());
    // Charts that share a texture coordinate at a vertex, but no edge, are apart: here two quads that both have all of
    // the texture.
    const auto tiles = io::impl::parse_obj("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nvt 0 0\nvt 1 0\n"
                                           "vt 1 1\nvt 0 1\nf 1/1 2/2 5/3 4/4\nf 2/2 3/1 6/4 5/1\n")
                           .cut_seams()
                           .value();
    CHECK(tiles.surface.vertex_count() == 8);
    CHECK(tiles.seam_vertices == 2);
    CHECK(std::vector<taut::idx>(tiles.corners.begin(), tiles.corners.begin() + 4) ==
          std::vector<taut::idx>{0, 1, 4, 3});
    CHECK(tiles.corners[4] + tiles.corners[7] == 6 + 7);
    CHECK_THROWS_AS(io::impl::parse_obj(head + "vt 0 0\nf 1/1 2/1 3/1\nf 2/1 4 3/1\n").cut_seams(), io::texcoord_error);

    // A polygon stays whole, though a third triangle meets its two halves where it is split.
    const auto non_manifold =
        io::impl::parse_obj("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 2 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 5 5\n"
                            "f 1/5 3/5 5/5\nf 1/1 2/2 3/3 4/4\n");
    const auto whole = non_manifold.cut_seams().value();
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(whole.corners[non_manifold.faces.corner(c, k)] == whole.surface.cells()[c][k]);

    // The file says where each sheet of a vertex lies, and keeps its vertices.
    const temporary_folder folder;
    io::write_obj(folder / "out.obj", file, cut, numbered(6));
    CHECK(folder.read(folder / "out.obj") ==
          head + "vt 0 -1\nvt 1 -1\nvt 2 -1\nvt 3 -1\nvt 4 -1\nvt 5 -1\nf 1/1 2/2 3/3\nf 2/5 4/4 3/6\n");
    const auto again = io::read_surface_file(folder / "out.obj").cut_seams().value();
    CHECK(again.surface.cells() == cut.surface.cells());
}

TEST_CASE("surface_file: a texture coordinate that is not there is an error, not a read beyond the end")
{
    auto file = io::impl::parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
    file.texcoord_cells[0][1] = 7;
    CHECK_THROWS_AS(file.texcoord(0, 1), io::texcoord_error);
    CHECK_THROWS_AS(file.vertex_texcoords(), io::texcoord_error);
    CHECK_THROWS_AS(file.cut_seams(), io::texcoord_error);
}
