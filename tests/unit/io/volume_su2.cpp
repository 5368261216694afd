// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <taut/io/read_volume.hpp>

#include "support/volume_texts.hpp"

namespace
{

using namespace taut;

io::volume_file read_su2(const std::string& text)
{
    return io::parse_volume(text, io::volume_format::su2, "a.su2");
}

TEST_CASE("SU2: markers are groups by their names")
{
    const auto file = read_su2(test::su2_text(test::small_volume(false)));
    CHECK(file.find_group("side7").vertices == std::vector<idx>{0, 1, 2});
    CHECK(file.find_group("side7").dimension == 2);
    const auto planar = read_su2(test::su2_text(test::small_square(), 2));
    CHECK(planar.find_group("side5").vertices == std::vector<idx>{0, 1});
    CHECK(planar.find_group("side5").dimension == 1);
}

TEST_CASE("SU2: keys in any order and spelling, comments, what stands behind numbers")
{
    const auto file = read_su2(
        "% first\nNZONE=1\nNDIME = 3 % space\nNPOIN= 4 4\n0 0 0\n1 0 0 1 % x\n%\n0 1 0 2\n"
        "0 0 1.00 3\nNMARK= 2\nMARKER_TAG=  wing tip \nMARKER_ELEMS= 1\n5 0 1 2 0\n"
        "MARKER_TAG= wing\nMARKER_ELEMS= 1\n5 1 3 2\nMARKER_TAG= SEND_RECEIVE\nMARKER_ELEMS= 1\nSEND_RECV= 1\n1 0\n"
        "NELEM= 1\n10 0 1 2 3 0\n"
        "FFD_NBOX= 1\nFFD_TAG= BOX\n1.0 2.0\n");
    CHECK(io::tetrahedra_of(file).cell_count() == 1);
    CHECK(file.groups.size() == 1); // both are called wing, and are joined
    CHECK(file.find_group("wing:2").vertices == std::vector<idx>{0, 1, 2, 3});
}

TEST_CASE("SU2: a marker named many times is one")
{
    std::string text = test::su2_text(test::small_square(), 2);
    const std::size_t groups = read_su2(text).groups.size();
    for (int k = 0; k < 2000; ++k)
        text +=
            "MARKER_TAG= many\nMARKER_ELEMS= 1\n3 " + std::to_string(k % 3) + ' ' + std::to_string(k % 3 + 1) + '\n';
    const auto file = read_su2(text);
    CHECK(file.groups.size() == groups + 1);
    CHECK(file.find_group("many:1").vertices == std::vector<idx>{0, 1, 2, 3});
}

TEST_CASE("SU2: errors tell the line")
{
    const std::string text = test::su2_text(test::small_volume(false));
    const auto refuses = [](const std::string& bytes, const char* message)
    { CHECK_THROWS_WITH_AS(read_su2(bytes), doctest::Contains(message), io::io_error); };
    const auto with = [&](const std::string& from, const std::string& to)
    {
        std::string changed = text;
        return changed.replace(changed.find(from), from.size(), to);
    };
    refuses("hello", "not an SU2 mesh: there is no NDIME=");
    refuses(with("NDIME= 3", "NDIME= 1"), "line 2: NDIME= 1; it must be 2 or 3");
    refuses(with("NDIME= 3", "NDIME= 3\nNZONE= 2"), "line 3: several zones");
    refuses(with("\n10 0 1 2 3", "\n10 0 1 2 5"), "line 4: point 5 of 5; they count from 0");
    refuses(with("\n10 0 1 2 3", "\n24 0 1 2 3"), "cells of higher order");
    refuses(with("\n10 0 1 2 3", "\n11 0 1 2 3"), "element type 11 is none of SU2");
    refuses(with("NPOIN= 5", "NPOIN= 50000"), "NPOIN is 50000, more than the rest");
    refuses(with("MARKER_ELEMS= 1", "MARKER_ELEMS= 2"), "the file ends before the type of an element");
    refuses(with("MARKER_ELEMS= 1", ""), "no MARKER_ELEMS=");
}

} // namespace
