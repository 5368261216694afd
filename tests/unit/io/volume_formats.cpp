// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <taut/errors.hpp>
#include <taut/impl/files/volume/read_volume.hpp>
#include <taut/volume_file.hpp>

#include "support/temporary_folder.hpp"
#include "support/volume_promises.hpp"
#include "support/volume_texts.hpp"

namespace
{

using namespace taut;
using namespace taut::impl;
using io::volume_format;
using test::small_volume;
using test::volume_encoding;

constexpr auto little = std::endian::little, big = std::endian::big;

struct written_sample
{
    std::string name;
    volume_format format;
    bool single;
    std::string bytes;
};

/// A mesh in every format that is one file.
std::vector<written_sample> every_file(const test::volume_sample& s)
{
    std::vector<written_sample> all = {{"medit", volume_format::medit, false, test::medit_text(s)},
                                       {"medit, CR LF", volume_format::medit, false, test::medit_text(s, 3, "\r\n")},
                                       {"su2", volume_format::su2, false, test::su2_text(s)},
                                       {"su2, CR LF", volume_format::su2, false, test::su2_text(s, 3, "\r\n")}};
    for (const bool text : {true, false})
        for (const auto order : {little, big})
        {
            const std::string name = text ? ", text" : order == little ? ", little" : ", big";
            all.push_back({"gmsh 2" + name, volume_format::gmsh, false, test::gmsh2_text(s, {text, order})});
            all.push_back({"gmsh 4" + name, volume_format::gmsh, false, test::gmsh4_text(s, {text, order})});
            for (const bool single : {false, true})
            {
                const volume_encoding e{text, order, single};
                const std::string kind = name + (single ? ", single" : "");
                all.push_back({"vtk 3" + kind, volume_format::vtk, single, test::vtk_text(s, e, 3)});
                all.push_back({"vtk 5" + kind, volume_format::vtk, single, test::vtk_text(s, e, 5)});
                all.push_back({"vtu" + kind, volume_format::vtu, single, test::vtu_text(s, e)});
                all.push_back({"vtu, long" + kind, volume_format::vtu, single, test::vtu_text(s, e, true)});
            }
        }
    return all;
}

using plain_cell = std::pair<io::cell_kind, std::vector<idx>>;

std::vector<plain_cell> cells_of(const io::volume_file& file)
{
    std::vector<plain_cell> cells;
    for (const auto& block : file.cells)
        for (std::size_t c = 0; c < block.size(); ++c)
            cells.emplace_back(block.kind, std::vector<idx>(block.cell(c).begin(), block.cell(c).end()));
    return cells;
}

TEST_CASE("volumes: every format is read, and written with all bytes but those of coordinates that move")
{
    for (const bool mixed : {false, true})
    {
        const auto s = small_volume(mixed);
        std::vector<plain_cell> expected;
        for (std::size_t c = 0; c < s.cells.size(); ++c) expected.emplace_back(s.cells[c].kind, s.vtk_corners(c));
        for (const auto& sample : every_file(s))
        {
            CAPTURE(sample.name);
            const auto file = io::impl::parse_volume(sample.bytes, sample.format);
            CHECK(file.dimension == 3);
            CHECK(file.places.single == sample.single);
            REQUIRE(file.points.size() == s.points.size());
            for (std::size_t v = 0; v < s.points.size(); ++v)
                for (int k = 0; k < 3; ++k)
                {
                    const double x = s.points[v][k];
                    // A text of a file that declares single precision is read as it is written.
                    const bool rounded = sample.single && !file.places.text;
                    CHECK((file.points[v][k] == x || (sample.single && float(file.points[v][k]) == float(x))));
                    if (rounded) CHECK(file.points[v][k] == static_cast<double>(static_cast<float>(x)));
                }
            auto cells = cells_of(file);
            auto wanted = expected;
            if (sample.format == volume_format::medit || sample.format == volume_format::su2)
                std::sort(cells.begin(), cells.end()), std::sort(wanted.begin(), wanted.end());
            CHECK(cells == wanted);
            CHECK(test::broken_promise(file, [&](const std::string& bytes)
                                       { return io::impl::parse_volume(bytes, sample.format); }) == "");
        }
    }
}

TEST_CASE("volumes: cut off anywhere, a file is refused with its place or still in range")
{
    for (const auto& sample : every_file(small_volume(true)))
        for (std::size_t n = 0; n < sample.bytes.size(); n += 7)
        {
            CAPTURE(sample.name);
            CAPTURE(n);
            try
            {
                const auto file = io::impl::parse_volume(sample.bytes.substr(0, n), sample.format);
                CHECK(test::broken_promise(file, [&](const std::string& bytes)
                                           { return io::impl::parse_volume(bytes, sample.format); }) == "");
            }
            catch (const io::io_error&)
            {
            }
        }
}

TEST_CASE("volumes: planar files have two coordinates, or no volume and one z")
{
    const auto s = test::small_square();
    for (const auto& [format, bytes] :
         {std::pair(volume_format::medit, test::medit_text(s, 2)),
          std::pair(volume_format::medit, test::medit_text(s, 3)), std::pair(volume_format::su2, test::su2_text(s, 2)),
          std::pair(volume_format::gmsh, test::gmsh2_text(s, {})),
          std::pair(volume_format::vtk, test::vtk_text(s, {}, 3))})
    {
        const auto read = [format = format](const std::string& b) { return io::impl::parse_volume(b, format); };
        const auto file = read(bytes);
        CHECK(file.dimension == 2);
        CHECK(file.triangles().cell_count() == 4);
        CHECK_THROWS_AS(file.tetrahedra(), mesh_error);
        CHECK(test::broken_promise(file, read) == "");
    }
    CHECK_THROWS_WITH_AS(
        io::impl::parse_volume(test::medit_text(small_volume(false)), volume_format::medit).triangles(),
        doctest::Contains("no planar mesh"), mesh_error);
}

TEST_CASE("volumes: a problem's points are its initial map, its group what is fixed")
{
    const std::string text =
        "4 3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n4 3\n0 0 0\n1.0 0 0\n0 1 0\n0 0 -1e0\n1 4\n0 1 2 3\n2\n2\n0\n";
    const auto read = [](const std::string& bytes) { return io::impl::parse_volume(bytes, volume_format::problem); };
    const auto file = read(text);
    CHECK(file.points[3] == vec3(0, 0, -1));
    CHECK(file.rest[3] == vec3(0, 0, 1));
    CHECK(file.find_group("fixed").vertices == std::vector<idx>{0, 2});
    CHECK(file.tetrahedra().points()[3] == vec3(0, 0, 1)); // at rest
    CHECK(test::broken_promise(file, read) == "");
    const auto planar = read("3 2\n0 0\n1 0\n0 1\n3 2\n0 0\n2 0\n0 2\n1 3\n0 1 2\n0\n");
    CHECK(planar.dimension == 2);
    CHECK(planar.points[1] == vec3(2, 0, 0));
    CHECK(test::broken_promise(planar, read) == "");
}

TEST_CASE("volumes: the extension tells the format")
{
    const test::temporary_folder folder;
    const auto s = small_volume(false);
    folder.write(folder / "a.MESH", test::medit_text(s));
    folder.write(folder / "b", test::su2_text(s));
    folder.write(folder / "c.meshb", "x");
    CHECK(io::read_volume(folder / "a.MESH").cell_count() == 2);
    CHECK(io::read_volume(folder / "b", volume_format::su2).cell_count() == 2);
    CHECK_THROWS_WITH_AS(io::read_volume(folder / "b"), doctest::Contains("unknown kind of file"), io::io_error);
    CHECK_THROWS_WITH_AS(io::read_volume(folder / "c.meshb"), doctest::Contains("convert it to .mesh"), io::io_error);
    CHECK_THROWS_AS(io::read_volume(folder / "d.vtu"), io::io_error);
}

} // namespace
