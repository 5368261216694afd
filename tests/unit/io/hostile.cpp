// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <taut/impl/files/file/read_file.hpp>
#include <taut/impl/files/surface/obj.hpp>
#include <taut/impl/files/surface/off.hpp>
#include <taut/impl/files/surface/ply.hpp>
#include <taut/impl/files/surface/stl.hpp>
#include <taut/surface_file.hpp>

namespace
{

using namespace taut;
using namespace taut::impl;

/// The files that fuzzers start from: they use what the readers know, and some of what they must refuse.
std::vector<std::string> samples(const std::string& format)
{
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(__FILE__).parent_path() /
                                                                 "../../fuzz/corpus" / format))
        paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    REQUIRE(paths.size() > 3);
    std::vector<std::string> bytes;
    for (const auto& path : paths) bytes.push_back(io::impl::read_file(path));
    return bytes;
}

/// Whatever the bytes, a reader returns a surface or throws an error of ours.
template <class Parse>
void feed(Parse parse, const std::string& bytes)
{
    try
    {
        const auto f = parse(bytes);
        CHECK(f.surface.cell_count() > 0);
        if (!f.texcoord_cells.empty()) CHECK(f.texcoord_cells.size() == f.surface.cells().size());
        for (const auto& t : f.texcoord_cells)
            for (const taut::idx i : t) CHECK(i < static_cast<taut::idx>(f.texcoords.size()));
    }
    catch (const error& e)
    {
        CHECK(std::string(e.what()).size() > 0);
    }
}

/// The sample, all its beginnings, and random changes of it.
template <class Parse>
void torture(Parse parse, const std::string& sample)
{
    feed(parse, sample);
    for (std::size_t n = 0; n < sample.size(); ++n) feed(parse, sample.substr(0, n));
    std::mt19937 rng(static_cast<unsigned>(sample.size()));
    using namespace std::string_literals;
    const std::string spice = "0123456789-+.eE/\\# \n\r\tnaif\0\xff\x7f"s;
    for (int trial = 0; trial < 1000; ++trial)
    {
        std::string s = sample;
        for (unsigned k = 0; k < 1 + rng() % 4; ++k)
        {
            const std::size_t at = rng() % s.size();
            switch (rng() % 3)
            {
            case 0:
                s[at] = spice[rng() % spice.size()];
                break;
            case 1:
                s.insert(at, 1, spice[rng() % spice.size()]);
                break;
            default:
                s.erase(at, 1 + rng() % 3);
                break;
            }
            if (s.empty()) break;
        }
        feed(parse, s);
    }
}

} // namespace

TEST_CASE("hostile files: OBJ")
{
    for (const auto& s : samples("obj")) torture([](const std::string& t) { return io::impl::parse_obj(t); }, s);
}

TEST_CASE("hostile files: OFF")
{
    for (const auto& s : samples("off")) torture([](const std::string& t) { return io::impl::parse_off(t); }, s);
}

TEST_CASE("hostile files: PLY")
{
    for (const auto& s : samples("ply")) torture([](const std::string& t) { return io::impl::parse_ply(t); }, s);
}

TEST_CASE("hostile files: STL")
{
    for (const auto& s : samples("stl")) torture([](const std::string& t) { return io::impl::parse_stl(t); }, s);
}
