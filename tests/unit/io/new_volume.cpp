// SPDX-License-Identifier: MIT
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>
#include <taut/errors.hpp>
#include <taut/volume_file.hpp>

namespace
{

using namespace taut;

const std::vector<vec3> corners = {{0, 0, 0}, {1, 0, 0.1}, {0, 1, 1e-17}, {1. / 3, 0, 1}, {1, 1, 1e300}};

const char* const names[] = {"a.mesh", "a.msh", "a.vtk", "a.VTU"};

} // namespace

TEST_CASE("new volume: tetrahedra made in memory are read back bit for bit")
{
    const test::temporary_folder folder;
    const mesh<tetrahedron> m(corners, {{0, 1, 2, 3}, {1, 4, 2, 3}});
    for (const char* name : names)
    {
        CAPTURE(name);
        io::write_volume(folder / name, m);
        const auto back = io::read_volume(folder / name);
        CHECK(back.points() == m.points());
        CHECK(back.cells() == m.cells());

        std::vector<vec3> moved(corners.size(), vec3(0.5));
        moved[3] = {1, 2, 3};
        io::write_volume(folder / name, m, std::span<const vec3>(moved));
        CHECK(io::read_volume_file(folder / name).points == moved);
    }
}

TEST_CASE("new volume: triangles of the plane keep their plane")
{
    const test::temporary_folder folder;
    const mesh<triangle> m({{0, 0, 5}, {1, 0, 5}, {0, 0.1, 5}, {1, 1, 5}}, {{0, 1, 2}, {1, 3, 2}});
    for (const char* name : names)
    {
        CAPTURE(name);
        const std::vector<vec2> x = {{0, 0}, {2, 0}, {0, 2}, {2, 2}};
        io::write_volume(folder / name, m, std::span<const vec2>(x));
        const auto file = io::read_volume_file(folder / name);
        CHECK(file.dimension == 2);
        CHECK(file.triangles().cells() == m.cells());
        CHECK(file.points == std::vector<vec3>{{0, 0, 5}, {2, 0, 5}, {0, 2, 5}, {2, 2, 5}});
    }
    const mesh<triangle> bent({{0, 0, 0}, {1, 0, 0}, {0, 1, 1}}, {{0, 1, 2}});
    CHECK_THROWS_WITH_AS(io::write_volume(folder / "a.vtk", bent), doctest::Contains("write_obj"), parameter_error);
}

TEST_CASE("new volume: what cannot be written is refused, and leaves no file")
{
    const test::temporary_folder folder;
    const mesh<tetrahedron> m(corners, {{0, 1, 2, 3}});
    for (const char* name : {"a.node", "a.su2", "a.prob", "a.obj", "a"})
        CHECK_THROWS_WITH_AS(io::write_volume(folder / name, m), doctest::Contains("MEDIT (.mesh)"), io::io_error);
    std::vector<vec3> x(4);
    CHECK_THROWS_WITH_AS(io::write_volume(folder / "a.vtk", m, std::span<const vec3>(x)),
                         doctest::Contains("4 positions for 5 vertices"), parameter_error);
    x.assign(5, vec3(std::numeric_limits<double>::infinity()));
    CHECK_THROWS_WITH_AS(io::write_volume(folder / "a.vtk", m, std::span<const vec3>(x)),
                         doctest::Contains("position 0 is not finite"), parameter_error);
    CHECK_FALSE(std::filesystem::exists(folder / "a.vtk"));
}
