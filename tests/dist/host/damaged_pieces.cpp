// SPDX-License-Identifier: MIT
// Meshes in pieces, damaged at random: they are read, or refused by one error on all processes.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <dist/volume_files.hpp>
#include <taut/impl/dist/ranges/open_volume.hpp>

namespace taut::test
{

namespace
{

using files = std::map<std::string, std::string>; ///< texts by names

/// Numbers as a list of OpenFOAM: text, or bytes.
std::string list_of(const std::vector<std::int32_t>& numbers, bool binary)
{
    std::string text = std::to_string(numbers.size()) + "\n(";
    if (binary)
        text.append(reinterpret_cast<const char*>(numbers.data()), 4 * numbers.size());
    else
        for (const auto n : numbers) text += std::to_string(n) + '\n';
    return text + ")\n";
}

std::string head(const std::string& type, bool binary)
{
    return std::string("FoamFile { version 2.0; format ") + (binary ? "binary" : "ascii") +
           "; arch \"LSB;label=32;scalar=64\"; class " + type + "; }\n";
}

/// A folder polyMesh of OpenFOAM, whose points count from `first` in the whole mesh.
void add_foam(files& all, const std::string& folder, const mesh<tetrahedron>& m, double shift, int first, bool binary)
{
    static constexpr std::array<std::array<std::size_t, 3>, 4> sides = {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
    std::map<std::array<idx, 3>, std::vector<std::pair<std::int32_t, std::array<idx, 3>>>> found;
    for (std::size_t c = 0; c < m.cells().size(); ++c)
        for (const auto& side : sides)
        {
            const std::array<idx, 3> around = {m.cells()[c][side[0]], m.cells()[c][side[1]], m.cells()[c][side[2]]};
            auto key = around;
            std::sort(key.begin(), key.end());
            found[key].emplace_back(static_cast<std::int32_t>(c), around);
        }
    std::vector<std::int32_t> owner, neighbour, corners, ends = {0}, numbers;
    for (const std::size_t n : {2U, 1U})
        for (const auto& [key, of] : found)
        {
            if (of.size() != n) continue;
            owner.push_back(of[0].first);
            if (n == 2) neighbour.push_back(of[1].first);
            corners.insert(corners.end(), of[0].second.begin(), of[0].second.end());
            ends.push_back(static_cast<std::int32_t>(corners.size()));
        }
    std::string points = std::to_string(m.points().size()) + "\n(", faces = std::to_string(owner.size()) + "\n(\n";
    for (vec3 p : m.points())
    {
        p.z += shift;
        if (binary)
            points.append(reinterpret_cast<const char*>(&p), 24);
        else
            points += '(' + digits(p.x) + ' ' + digits(p.y) + ' ' + digits(p.z) + ")\n";
        numbers.push_back(first + static_cast<std::int32_t>(numbers.size()));
    }
    for (std::size_t f = 0; f < owner.size(); ++f)
        faces += "3(" + std::to_string(corners[3 * f]) + ' ' + std::to_string(corners[3 * f + 1]) + ' ' +
                 std::to_string(corners[3 * f + 2]) + ")\n";
    all[folder + "points"] = head("vectorField", binary) + points + ")\n";
    all[folder + "faces"] = binary ? head("faceCompactList", true) + list_of(ends, true) + list_of(corners, true)
                                   : head("faceList", false) + faces + ")\n";
    all[folder + "owner"] = head("labelList", binary) + list_of(owner, binary);
    all[folder + "neighbour"] = head("labelList", binary) + list_of(neighbour, binary);
    all[folder + "pointProcAddressing"] = head("labelList", binary) + list_of(numbers, binary);
    all[folder + "boundary"] = head("polyBoundaryMesh", false) + "1\n(\nwall { type patch; nFaces " +
                               std::to_string(owner.size() - neighbour.size()) + "; startFace " +
                               std::to_string(neighbour.size()) + "; }\n)\n";
    all[folder + "cellZones"] = head("regIOobject", binary) + "1\n(\nlow { type cellZone; cellLabels List<label> " +
                                list_of({0, 1}, binary) + "; }\n)\n";
    all[folder + "faceZones"] = head("regIOobject", false) +
                                "1\n(\nlow { type faceZone; faceLabels List<label> 2(0 1); flipMap List<bool> 2{0}; "
                                "}\n)\n";
}

files foam_case(bool binary)
{
    const auto m = bar(1);
    files all;
    add_foam(all, "case/processor0/constant/polyMesh/", m, 0, 0, binary);
    add_foam(all, "case/processor1/constant/polyMesh/", m, 9, static_cast<int>(m.points().size()), binary);
    return all;
}

files vtk_pieces()
{
    const auto m = bar(1);
    return {{"a.pvtu", "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid GhostLevel=\"0\">\n"
                       "<Piece Source=\"a/0.vtu\"/>\n<Piece Source=\"a/1.vtu\"/>\n</PUnstructuredGrid></VTKFile>\n"},
            {"a/0.vtu", vtu_of(m)},
            {"a/1.vtu", vtu_of(m)}};
}

std::string damaged_piece(std::string text, std::mt19937& random)
{
    const auto any = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    const auto how = any(6);
    for (std::size_t k = 0; k <= any(3) && !text.empty(); ++k)
    {
        const std::size_t at = any(text.size());
        if (how == 0) text[at] = static_cast<char>(any(256));
        if (how == 1) text.erase(at, any(40));
        if (how == 2) text.resize(at);
        if (how == 3) text.insert(at, text.substr(any(text.size()), any(60)));
        if (how < 4) continue;
        // A number that lies.
        static constexpr std::array<const char*, 6> lies = {"-1",          "4294967296", "9223372036854775807",
                                                            "1000000000{", "65536{7}",   "99999999999999999999"};
        const std::size_t begin = text.find_first_of("0123456789", at);
        if (begin == text.npos) continue;
        const std::size_t end = std::min(text.find_first_not_of("0123456789", begin), text.size());
        text.replace(begin, end - begin, lies[any(lies.size())]);
    }
    return text;
}

void put_all(const common_folder& folder, const files& all)
{
    for (const auto& [name, text] : all)
    {
        if (rank_of() == 0) std::filesystem::create_directories((folder / name).parent_path());
        folder.put(name, text);
    }
}

/// The error of reading the pieces; empty: they are read, and written with all but coordinates as they were.
std::string failure(const dist::impl::communicator& all, const common_folder& folder, const std::string& name)
{
    std::string what;
    try
    {
        const auto volume = dist::impl::open_volume(all, folder / name);
        for (std::size_t g = 0; g < volume->groups.size() && g < 6; ++g) volume->members(g);
        const auto out = name == "case" ? folder / "out" : folder / "out.pvtu";
        for (const auto& file : volume->write(out, volume->piece.points)) file->commit();
    }
    catch (const error& e)
    {
        what = e.what();
        CHECK_FALSE(what.empty());
    }
    MPI_Barrier(MPI_COMM_WORLD);
    CHECK(all.all(what.empty()) == what.empty()); // all processes come to the same
    return what;
}

void damage(const std::string& name, const files& sound, int rounds)
{
    const dist::impl::communicator all(MPI_COMM_WORLD);
    const common_folder folder;
    put_all(folder, sound);
    CHECK(failure(all, folder, name) == "");
    std::mt19937 random(7);
    int refused = 0;
    for (int k = 0; k < rounds; ++k)
    {
        auto file = sound.begin();
        std::advance(file, static_cast<std::ptrdiff_t>(random() % sound.size()));
        folder.put(file->first, damaged_piece(file->second, random));
        refused += !failure(all, folder, name).empty();
        folder.put(file->first, file->second);
    }
    CHECK(refused > rounds / 4);
    CHECK(failure(all, folder, name) == "");
}

/// What reading says of a case of which one file has another text.
std::string failure_with(const std::string& file, const std::string& from, const std::string& to)
{
    const dist::impl::communicator all(MPI_COMM_WORLD);
    const common_folder folder;
    auto changed = foam_case(false);
    auto& text = changed["case/processor0/constant/polyMesh/" + file];
    const auto at = text.find(from);
    REQUIRE(at != text.npos);
    text.replace(at, from.size(), to);
    put_all(folder, changed);
    auto what = failure(all, folder, "case");
    return all.shared(what); // of the process that has the piece
}

} // namespace

TEST_CASE("dist damaged pieces of OpenFOAM")
{
    damage("case", foam_case(false), 70);
    damage("case", foam_case(true), 70);
}

TEST_CASE("dist damaged pieces of VTK")
{
    damage("a.pvtu", vtk_pieces(), 100);
}

TEST_CASE("dist lengths that lie in a case of OpenFOAM")
{
    const std::string n = std::to_string(bar(1).points().size());
    CHECK(failure_with("points", n + "\n(", "1000000000000\n{").find("more than the rest of the file") !=
          std::string::npos);
    std::string many = "3(";
    for (int k = 0; k < 200; ++k) many.insert(0, "300000{0}\n"); // each is allowed by itself
    CHECK(failure_with("faces", "3(", many).find("of one value is too long") != std::string::npos);
    std::string twice = "wall { type patch; nFaces 9; startFace 0; }\nwall";
    for (int k = 0; k < 9; ++k) twice.insert(0, "w" + std::to_string(k) + " { type patch; nFaces 9; startFace 0; }\n");
    CHECK(failure_with("boundary", "wall", twice).find("faces that are not there") != std::string::npos);
    CHECK(failure_with("owner", "labelList", "decomposedBlockData").find("-fileHandler uncollated") !=
          std::string::npos);
    CHECK(failure_with("cellZones", "2\n(0", "2\n(77777").find("a zone names item 77777") != std::string::npos);
}

} // namespace taut::test
