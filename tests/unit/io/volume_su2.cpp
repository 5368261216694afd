// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <taut/errors.hpp>
#include <taut/impl/files/volume/read_volume.hpp>
#include <taut/volume_file.hpp>

#include "support/volume_texts.hpp"

namespace
{

using namespace taut;

io::volume_file read_su2(const std::string& text)
{
    return io::impl::parse_volume(text, io::volume_format::su2, "a.su2");
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
    CHECK(file.tetrahedra().cell_count() == 1);
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

/// A square with a corner at x; the points are at NPOIN's front or behind.
std::string zone_text(int number, double x, bool points_first, const std::string& marker)
{
    const std::string points = "NPOIN= 4\n" + std::to_string(x) + " 0\n" + std::to_string(x + 1) + " 0\n" +
                               std::to_string(x + 1) + " 1\n" + std::to_string(x) + " 1\n";
    const std::string cells = "NELEM= 2\n5 0 1 2\n5 0 2 3\n";
    return "IZONE= " + std::to_string(number) + "\nNDIME= 2\n" + (points_first ? points + cells : cells + points) +
           "NMARK= 1\nMARKER_TAG= " + marker + "\nMARKER_ELEMS= 1\n3 0 1\n";
}

TEST_CASE("SU2: one zone of several is read, in any order, with its own markers")
{
    const std::string text = "NZONE= 3 % three\n" + zone_text(3, 30, true, "wall") + zone_text(1, 10, false, "wall") +
                             zone_text(2, 20, true, "rim") + "FFD_NBOX= 1\nFFD_TAG= BOX\n1.0 2.0\n";
    for (int zone = 1; zone <= 3; ++zone)
    {
        const auto file = io::impl::parse_volume(text, io::volume_format::su2, "a.su2", zone);
        REQUIRE(file.points.size() == 4);
        CHECK(file.points[0] == vec3(10 * zone, 0, 0));
        REQUIRE(file.groups.size() == 1);
        CHECK(file.groups[0].name == (zone == 2 ? "rim" : "wall"));
        CHECK(file.groups[0].vertices == std::vector<idx>{0, 1});
        CHECK(file.notes.back() == "zone " + std::to_string(zone) + " of 3: the others stay as they are");
    }
    const auto refuses = [](const std::string& bytes, int zone, const char* message)
    {
        CHECK_THROWS_WITH_AS(io::impl::parse_volume(bytes, io::volume_format::su2, "a.su2", zone),
                             doctest::Contains(message), io::io_error);
    };
    refuses(text, 0, "3 zones; say which one is meant: --zone N, from 1 to 3");
    refuses(text, 4, "zone 4 of 3; they count from 1");
    refuses("NZONE= 2\n" + zone_text(1, 0, true, "a"), 1, "line 1: NZONE= 2, but 1 zone begins with IZONE=");
    refuses("NZONE= 2\n" + zone_text(1, 0, true, "a") + zone_text(1, 0, true, "a"), 1, "zone 1 is there twice");
    refuses("NZONE= 2\n" + zone_text(1, 0, true, "a") + zone_text(3, 0, true, "a"), 1, "IZONE= 3 of 2 zones");
    refuses("NZONE= 2\n" + zone_text(1, 0, true, "a") + "IZONE= 2\n", 2, "there is no NDIME=");
    refuses("NZONE= 2\nIZONE= 1\nNDIME= 2\nNPOIN= 9\n0 0\n1 0\n" + zone_text(2, 0, true, "a"), 1, "a number");
    refuses("NZONE= 2\nIZONE= 1\nNDIME= 2\nNPOIN= 1\n0 0\nMARKER_TAG= a\nIZONE= 2\nMARKER_ELEMS= 0\n", 1,
            "no MARKER_ELEMS=");
    const auto single =
        io::impl::parse_volume("NZONE= 1\n" + zone_text(1, 5, true, "a"), io::volume_format::su2, "a", 1);
    CHECK(single.points[0].x == 5);
    CHECK_THROWS_AS(io::impl::parse_volume("1 2", io::volume_format::problem, "a.prob", 1), io::io_error);
}

TEST_CASE("SU2: a marker may say with which part of a partition it exchanges")
{
    const std::string head = "NDIME= 2\nNPOIN= 4\n0 0\n1 0\n1 1\n0 1\nNELEM= 2\n5 0 1 2\n5 0 2 3\nNMARK= 2\n";
    for (const char* keys : {"MARKER_ELEMS= 1\nSEND_RECV= 1\n", "MARKER_ELEMS= 1\n% with 2\nSEND_RECV = -2\n",
                             "SEND_RECV= 1\nMARKER_ELEMS= 1\n"})
    {
        const auto file =
            read_su2(head + "MARKER_TAG= shared\n" + keys + "1 3 0\nMARKER_TAG= a\nMARKER_ELEMS= 1\n3 0 1\n");
        CHECK(file.find_group("shared").vertices == std::vector<idx>{3});
        CHECK(file.find_group("a").vertices == std::vector<idx>{0, 1});
    }
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
    refuses(with("NDIME= 3", "NDIME= 3\nNZONE= 2"), "line 3: NZONE= 2, but 0 zones begin with IZONE=");
    refuses(with("\n10 0 1 2 3", "\n10 0 1 2 5"), "line 4: point 5 of 5; they count from 0");
    refuses(with("\n10 0 1 2 3", "\n24 0 1 2 3"), "cells of higher order");
    refuses(with("\n10 0 1 2 3", "\n11 0 1 2 3"), "element type 11 is none of SU2");
    refuses(with("NPOIN= 5", "NPOIN= 50000"), "NPOIN is 50000, more than the rest");
    refuses(with("MARKER_ELEMS= 1", "MARKER_ELEMS= 2"), "the file ends before the type of an element");
    refuses(with("MARKER_ELEMS= 1", ""), "no MARKER_ELEMS=");
}

} // namespace
