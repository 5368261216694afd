// SPDX-License-Identifier: MIT
// Volumes that all processes read and write, each a range.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

#include <dist/volume_files.hpp>
#include <taut/errors.hpp>
#include <taut/impl/files/volume/write_volume.hpp>
#include <taut/volume_file.hpp>

namespace taut::test
{

namespace
{

std::int64_t sum(std::size_t n)
{
    auto x = static_cast<std::int64_t>(n);
    MPI_Allreduce(MPI_IN_PLACE, &x, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
    return x;
}

vec3 moved(const vec3& p)
{
    return p.z == 0 ? p : vec3(p.x, p.y + 1.0 / 3, 1.5 * p.z);
}

std::size_t names_in(const std::filesystem::path& folder)
{
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

/// What must hold of a file of bar(2), however it is read: places are ids, the group has the vertices of the floor, and
/// what is written is the file with other coordinates.
void expect_file(const std::filesystem::path& input, const std::string& group, bool by_ranges)
{
    const auto m = bar(2);
    INFO(input.string());
    const dist::volume_pieces file(MPI_COMM_WORLD, input);
    CHECK_MESSAGE(file.read_whole().empty() == by_ranges, file.read_whole());
    const auto& piece = file.piece();
    CHECK(sum(piece.ids.size()) == static_cast<std::int64_t>(m.points().size()));
    CHECK(sum(piece.cells.size()) == m.cell_count());
    bool same = true;
    for (std::size_t v = 0; v < piece.ids.size(); ++v)
        same = same && piece.points[v] == m.points()[static_cast<std::size_t>(piece.ids[v])];
    CHECK(same);
    std::size_t floor = 0;
    for (const vec3& p : m.points()) floor += p.z == 0;
    const auto members = file.members(group);
    CHECK(sum(members.size()) == static_cast<std::int64_t>(floor));
    CHECK(std::all_of(members.begin(), members.end(), [&](std::int64_t v) { return file.point(v).z == 0; }));
    CHECK_THROWS_AS(file.members("nobody"), io::group_error);
    CHECK(static_cast<bool>(dist::check(MPI_COMM_WORLD, piece)));

    const auto output = input.parent_path() / ("out" + input.extension().string());
    file.write(output, piece.points);
    MPI_Barrier(MPI_COMM_WORLD);
    CHECK(bytes_of(output) == bytes_of(input));
    std::vector<vec3> x;
    for (const vec3& p : piece.points) x.push_back(moved(p));
    file.write(output, x);
    MPI_Barrier(MPI_COMM_WORLD);
    const auto whole = io::read_volume_file(input), written = io::read_volume_file(output);
    std::vector<vec3> all;
    for (const vec3& p : whole.points) all.push_back(moved(p));
    CHECK(written.points == all);
    CHECK(bytes_of(output) == io::impl::with_points(whole, all)); // as one process writes it
    MPI_Barrier(MPI_COMM_WORLD);
}

} // namespace

TEST_CASE("dist files: formats by ranges")
{
    const common_folder folder;
    const auto m = bar(2);
    expect_file(folder.put("bar.su2", su2_of(m)), "floor", true);
    expect_file(folder.put("bar.mesh", medit_of(m)), "triangles:7", true);
    expect_file(folder.put("bar2.msh", gmsh2_of(m)), "floor", true);
    expect_file(folder.put("gaps.msh", gmsh2_of(m, 3)), "floor", true);
    expect_file(folder.put("bar4.msh", gmsh4_of(m)), "floor", true);
    expect_file(folder.put("bar.vtu", vtu_of(m)), "floor:1", true);
}

TEST_CASE("dist files: TetGen's three files")
{
    const common_folder folder;
    const auto m = bar(2);
    const lines_of l{m};
    const auto floor = l.floor();
    const std::string nodes = "# points\n" + std::to_string(m.points().size()) + " 3 0 0\n" + l.points("", 0);
    folder.put("bar.ele", std::to_string(m.cells().size()) + " 4 0\n" + l.cells("", "", 0, 1, true));
    std::string faces = std::to_string(floor.size()) + " 1\n";
    for (std::size_t k = 0; k < floor.size(); ++k)
        faces += std::to_string(k) + ' ' + std::to_string(floor[k][0]) + ' ' + std::to_string(floor[k][1]) + ' ' +
                 std::to_string(floor[k][2]) + " 2\n";
    folder.put("bar.face", faces);
    expect_file(folder.put("bar.node", nodes), "faces:2", true);
    CHECK(bytes_of(folder / "out.face") == faces);
}

TEST_CASE("dist files: what is not read by ranges is read by process 0")
{
    const common_folder folder;
    const auto m = bar(2);
    std::string text = medit_of(m);
    const auto joined = text.find('\n', text.find("Tetrahedra") + 20);
    text[joined] = ' '; // two cells in a line
    expect_file(folder.put("joined.mesh", text), "triangles:7", false);
    text = su2_of(m);
    std::string returns;
    for (const char c : text) returns += c == '\n' ? std::string("\r\n") : std::string(1, c);
    expect_file(folder.put("windows.su2", returns), "floor", true);
    std::replace(text.begin(), text.end(), '\n', '\r');
    const dist::volume_pieces old(MPI_COMM_WORLD, folder.put("old.su2", text));
    CHECK_FALSE(old.read_whole().empty());
    CHECK(sum(old.piece().cells.size()) == m.cell_count());
    // A short file has processes without a line.
    const dist::volume_pieces one(MPI_COMM_WORLD,
                                  folder.put("one.su2", "NDIME=3\nNELEM=1\n10 0 1 2 3\nNPOIN=4\n0 0 0\n1 0 0\n0 1 0\n"
                                                        "0 0 1\n"));
    CHECK(sum(one.piece().cells.size()) == 1);
    CHECK(one.read_whole().empty());
}

TEST_CASE("dist files: errors are those of one process, told to all, and nothing is half written")
{
    const common_folder folder;
    const auto fails = [&](const std::string& name, const std::string& text, const std::string& word)
    {
        std::string what;
        if (!text.empty()) folder.put(name, text);
        try
        {
            dist::volume_pieces(MPI_COMM_WORLD, folder / name);
        }
        catch (const error& e)
        {
            what = e.what();
        }
        INFO(what);
        CHECK(what.find(word) != what.npos);
    };
    const auto m = bar(2);
    fails("none.su2", "", "none.su2");
    std::string text = su2_of(m);
    fails("cut.su2", text.substr(0, text.size() / 2), "NPOIN");
    text.replace(text.find("\n10 ") + 4, 1, "99999");
    fails("corner.su2", text, "99999");
    text = medit_of(m);
    text.replace(text.find("\n0.5 ") + 1, 3, "abc");
    fails("word.mesh", text, "word.mesh");

    const dist::volume_pieces good(MPI_COMM_WORLD, folder.put("good.su2", su2_of(m)));
    MPI_Barrier(MPI_COMM_WORLD);
    const auto before = names_in(folder.path());
    CHECK_THROWS_AS(good.write(folder / "nowhere/x.su2", good.piece().points), error);
    std::vector<vec3> short_one = good.piece().points;
    if (rank_of() == size_of() - 1) short_one.clear();
    CHECK_THROWS_AS(good.write(folder / "x.su2", short_one), error);
    MPI_Barrier(MPI_COMM_WORLD);
    CHECK(names_in(folder.path()) == before);
}

TEST_CASE("dist files: deform from file to file")
{
    const common_folder folder;
    const auto m = bar(2);
    const auto input = folder.put("bar.su2", su2_of(m));
    dist::deform_params<tetrahedron> how;
    if (rank_of() == 0)
        for (std::size_t v = 0; v < m.points().size(); ++v)
            if (m.points()[v].z == 4) how.constraints.pin(static_cast<std::int64_t>(v), stretched(m.points()[v]));
    const auto report = dist::deform(MPI_COMM_WORLD, input, folder / "out.su2", how, {"floor"});
    CHECK(report.converged);
    const auto direct =
        dist::deform(MPI_COMM_WORLD, dealt(MPI_COMM_WORLD, m), {.constraints = ends(MPI_COMM_WORLD, m, stretched)});
    CHECK(report.energy == direct.report.energy); // the same bits
    MPI_Barrier(MPI_COMM_WORLD);
    const auto written = io::read_volume_file(folder / "out.su2");
    for (std::size_t v = 0; v < m.points().size(); ++v)
    {
        if (m.points()[v].z == 0) CHECK(written.points[v] == m.points()[v]);
        if (m.points()[v].z == 4) CHECK(written.points[v] == stretched(m.points()[v]));
    }
    MPI_Barrier(MPI_COMM_WORLD);
}

} // namespace taut::test
