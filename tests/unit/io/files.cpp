// SPDX-License-Identifier: MIT
#include <bit>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>

#include <doctest/doctest.h>

#include <support/meshes.hpp>
#include <support/temporary_folder.hpp>
#include <taut/errors.hpp>
#include <taut/surface_file.hpp>

using namespace taut;
using test::temporary_folder;

namespace
{

std::vector<vec2> flattened(const mesh<triangle>& m)
{
    std::vector<vec2> uv;
    for (const vec3& p : m.points()) uv.emplace_back(p.x, p.y);
    return uv;
}

const std::string triangle_obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

} // namespace

TEST_CASE("read_surface: the extension names the format, in either case")
{
    const temporary_folder folder;
    folder.write(folder / "a.obj", triangle_obj);
    folder.write(folder / "A.OBJ", triangle_obj);
    folder.write(folder / "b.Off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    folder.write(folder / "c.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                   "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                                   "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    for (const char* name : {"a.obj", "A.OBJ", "b.Off", "c.ply"})
    {
        const mesh<triangle> m = io::read_surface(folder / name);
        CHECK(m.vertex_count() == 3);
        CHECK(m.cell_count() == 1);
    }
    folder.write(folder / "d.stl", "solid");
    CHECK_THROWS_AS(io::read_surface(folder / "d.stl"), io::io_error);
}

TEST_CASE("read_surface: a file that cannot be read gives its path and the reason")
{
    const temporary_folder folder;
    try
    {
        io::read_surface(folder / "missing.obj");
        FAIL("no error");
    }
    catch (const io::io_error& e)
    {
        CHECK(e.path() == (folder / "missing.obj").string());
        CHECK(std::string(e.what()).find("No such file") != std::string::npos);
        CHECK_FALSE(e.place().has_value());
    }
    std::filesystem::create_directory(folder / "folder.obj");
    CHECK_THROWS_AS(io::read_surface(folder / "folder.obj"), io::io_error);
}

TEST_CASE("read_surface: an empty file is an empty mesh, a file with NaN names the vertex")
{
    const temporary_folder folder;
    folder.write(folder / "empty.obj", "");
    folder.write(folder / "nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n");
    const auto fault = [&](const char* name)
    {
        try
        {
            io::read_surface(folder / name);
        }
        catch (const mesh_error& e)
        {
            CHECK(std::string(e.what()).find(name) != std::string::npos);
            return e.fault();
        }
        FAIL("no error");
        return mesh_error::handles;
    };
    CHECK(fault("empty.obj") == mesh_error::empty);
    CHECK(fault("nan.obj") == mesh_error::non_finite);
}

TEST_CASE("write_obj: order, every coordinate and every texture coordinate come back bit for bit")
{
    const temporary_folder folder;
    std::mt19937_64 rng(4);
    const auto any_finite = [&]
    {
        double x = NAN;
        while (!std::isfinite(x)) x = std::bit_cast<double>(rng());
        return x;
    };
    std::vector<vec3> points;
    std::vector<vec2> uv;
    for (int i = 0; i < 3000; ++i)
    {
        points.emplace_back(any_finite(), any_finite(), any_finite());
        uv.emplace_back(any_finite(), any_finite());
    }
    points[7] = vec3(-0.0, 5e-324, 0.1);
    std::vector<std::array<taut::idx, 3>> cells;
    for (taut::idx i = 0; i < 2999; i += 3) cells.push_back({i + 2, i, i + 1});
    const mesh<triangle> m(points, cells);
    io::write_obj(folder / "out.obj", m, uv);
    const auto back = io::read_surface_file(folder / "out.obj");
    CHECK(back.surface.points() == m.points());
    CHECK(std::signbit(back.surface.points()[7].x));
    CHECK(back.surface.cells() == m.cells());
    CHECK(back.texcoords == uv);
    CHECK(back.texcoord_cells == m.cells());
    CHECK(back.notes.empty());
}

TEST_CASE("write_obj: the text is plain")
{
    const temporary_folder folder;
    io::write_obj(folder / "t.obj", mesh<triangle>({{0, 0, 0.5}, {1, 0, 0}, {0, 0.1, 0}}, {{2, 0, 1}}),
                  std::vector<vec2>{{0, 0}, {1, 0}, {0, -0.25}});
    CHECK(folder.read(folder / "t.obj") ==
          "v 0 0 0.5\nv 1 0 0\nv 0 0.1 0\nvt 0 0\nvt 1 0\nvt 0 -0.25\nf 3/3 1/1 2/2\n");
}

TEST_CASE("write_obj: one texture coordinate a vertex is required")
{
    const temporary_folder folder;
    CHECK_THROWS_AS(io::write_obj(folder / "x.obj", test::single_triangle(), std::vector<vec2>(2)), parameter_error);
    CHECK(folder.entries() == 0);
}

TEST_CASE("write_obj: a large surface comes back the same")
{
    const temporary_folder folder;
    const auto m = test::bumpy(100);
    io::write_obj(folder / "big.obj", m, flattened(m));
    const auto back = io::read_surface_file(folder / "big.obj");
    CHECK(back.surface.points() == m.points());
    CHECK(back.vertex_texcoords() == flattened(m));
}
