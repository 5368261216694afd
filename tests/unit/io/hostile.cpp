// SPDX-License-Identifier: MIT
#include <random>
#include <string>

#include <doctest/doctest.h>

#include <support/surface_texts.hpp>
#include <taut/io/read_surface.hpp>

namespace
{

using namespace taut;

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
            for (const taut::index i : t) CHECK(i < static_cast<taut::index>(f.texcoords.size()));
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
    CHECK_NOTHROW(parse(sample));
    for (std::size_t n = 0; n < sample.size(); ++n) feed(parse, sample.substr(0, n));
    std::mt19937 rng(static_cast<unsigned>(sample.size()));
    using namespace std::string_literals;
    const std::string spice = "0123456789-+.eE/\\# \n\r\tnaif\0\xff\x7f"s;
    for (int trial = 0; trial < 3000; ++trial)
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
    for (const auto& s : test::obj_texts()) torture([](const std::string& t) { return io::parse_obj(t); }, s);
}

TEST_CASE("hostile files: OFF")
{
    for (const auto& s : test::off_texts()) torture([](const std::string& t) { return io::parse_off(t); }, s);
}

TEST_CASE("hostile files: PLY")
{
    for (const auto& s : test::ply_texts()) torture([](const std::string& t) { return io::parse_ply(t); }, s);
}
