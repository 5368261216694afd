// SPDX-License-Identifier: MIT
// Files that are read by ranges, damaged at random: they are read as they stand, or by process 0, on all processes
// alike, and what is read is written back byte for byte.
#include <doctest/doctest.h>

#include <cstddef>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <dist/volume_files.hpp>
#include <taut/impl/dist/ranges/open_volume.hpp>
#include <taut/impl/dist/ranges/tokens.hpp>

namespace taut::test
{

namespace
{

std::string damaged(std::string text, std::mt19937& random)
{
    const auto any = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    const auto how = any(4);
    for (std::size_t k = 0; k <= any(3); ++k)
    {
        const std::size_t at = any(text.size());
        if (how == 0) text[at] = static_cast<char>(any(128));
        if (how == 1) text.erase(at, any(40));
        if (how == 2) text.resize(at + 1);
        if (how == 3) text.insert(at, text.substr(any(text.size()), any(60)));
        if (text.empty()) return "x";
    }
    return text;
}

/// Whether it was read by ranges.
bool reads(const dist::impl::communicator& all, const common_folder& folder, const std::string& name,
           const std::string& text)
{
    const auto path = folder.put(name, text);
    bool read = false;
    try
    {
        const auto volume = dist::impl::open_volume(all, path);
        for (std::size_t g = 0; g < volume->groups.size() && g < 4; ++g) volume->members(g);
        for (const auto& file : volume->write(folder / ("out-" + name), volume->piece.points)) file->commit();
        MPI_Barrier(MPI_COMM_WORLD);
        CHECK(bytes_of(folder / ("out-" + name)) == text);
        read = true;
    }
    catch (const dist::impl::unsuited& e)
    {
        CHECK(*e.what() != '\0');
    }
    MPI_Barrier(MPI_COMM_WORLD);
    return read;
}

} // namespace

TEST_CASE("dist damaged files")
{
    const dist::impl::communicator all(MPI_COMM_WORLD);
    const common_folder folder;
    const auto m = bar(1);
    const std::vector<std::pair<std::string, std::string>> files = {
        {"a.su2", su2_of(m)},         {"a.mesh", medit_of(m)}, {"a.msh", gmsh2_of(m)},
        {"gaps.msh", gmsh2_of(m, 3)}, {"b.msh", gmsh4_of(m)},  {"a.vtu", vtu_of(m)}};
    std::mt19937 random(1);
    for (const auto& [name, text] : files)
    {
        CHECK(reads(all, folder, name, text));
        for (int k = 0; k < 40; ++k) reads(all, folder, name, damaged(text, random));
    }
}

TEST_CASE("dist words of lines")
{
    const dist::impl::tokens words("  1 -2.5e3\t+4D-1 7% 9", '%');
    CHECK(words.size() == 4);
    CHECK(words.integer(0) == 1);
    CHECK(words.real(1) == -2500);
    CHECK(words.real(2) == 0.4);
    CHECK(words.integer(3) == 7);
    CHECK_THROWS_AS(words.integer(1), dist::impl::unsuited);
    CHECK_THROWS_AS(words.word(4), dist::impl::unsuited);
    CHECK_THROWS_AS(dist::impl::tokens("nan").real(0), dist::impl::unsuited);
    CHECK_THROWS_AS(dist::impl::tokens("1x").real(0), dist::impl::unsuited);
}

} // namespace taut::test
