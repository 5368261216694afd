// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <taut/errors.hpp>
#include <taut/impl/files/volume/read_volume.hpp>
#include <taut/volume_file.hpp>

#include "support/volume_texts.hpp"

namespace
{

using namespace taut;

io::volume_file read_gmsh(const std::string& bytes)
{
    return io::impl::parse_volume(bytes, io::volume_format::gmsh, "a.msh");
}

std::string replace_once(std::string text, const std::string& from, const std::string& to)
{
    return text.replace(text.find(from), from.size(), to);
}

TEST_CASE("gmsh: physical groups have their names, or dimension and tag")
{
    const auto s = test::small_volume(false);
    for (const bool text : {true, false})
        for (const auto& bytes : {test::gmsh2_text(s, {text}), test::gmsh4_text(s, {text})})
        {
            const auto file = read_gmsh(bytes);
            REQUIRE(file.groups.size() == 3);
            CHECK(file.find_group("the wall").vertices == std::vector<idx>{0, 1, 2});
            CHECK(file.find_group("the wall").dimension == 2);
            CHECK(file.find_group("body").vertices == std::vector<idx>{0, 1, 2, 3});
            CHECK(file.find_group("physical:3:2").vertices == std::vector<idx>{0, 1, 2, 4});
        }
}

TEST_CASE("gmsh: without physical groups the entities are groups; a name of several dimensions gets them")
{
    const auto s = test::small_volume(false);
    std::string text = test::gmsh2_text(s, {});
    for (const char* tags : {" 2 7 47", " 2 1 41", " 2 2 42"})
        text = replace_once(text, tags, std::string(" 2 0") + (tags + 4));
    const auto file = read_gmsh(text);
    CHECK(file.find_group("entity:2:47").vertices == std::vector<idx>{0, 1, 2});
    CHECK(file.find_group("entity:3:41").vertices == std::vector<idx>{0, 1, 2, 3});

    const auto both = read_gmsh(replace_once(test::gmsh2_text(s, {}), "\"body\"", "\"the wall\""));
    CHECK(both.find_group("the wall:2").vertices == std::vector<idx>{0, 1, 2});
    CHECK(both.find_group("the wall:3").vertices == std::vector<idx>{0, 1, 2, 3});
    CHECK_THROWS_AS(both.find_group("the wall"), io::group_error);
}

TEST_CASE("gmsh: physical tags make no more of a mesh than some times what it has")
{
    const auto s = test::small_volume(false);
    std::string tags;
    for (int k = 0; k < 1000; ++k) tags += ' ' + std::to_string(k % 9 + 1);
    const std::string text = test::gmsh4_text(s, {});
    const auto few = read_gmsh(text), many = read_gmsh(replace_once(text, " 1 2 1 -3", " 1000" + tags + " 1 -3"));
    CHECK(few.notes.empty());
    CHECK(many.cells.size() == few.cells.size());
    REQUIRE(many.notes.size() == 1);
    CHECK(many.notes[0].starts_with("the physical groups have more than 16 times what the mesh has"));
    CHECK(many.groups[0].name.starts_with("entity:"));
}

TEST_CASE("gmsh: nodes with parameters of version 2, and version 1 by name")
{
    const std::string nodes = "4\n1 0 0 0 0 1\n2 1 0 0 1 1 0.5\n3 0 1 0 2 1 0.5 0.25\n4 0 0 1 3 1\n";
    const std::string elements = "$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";
    const auto file = read_gmsh("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$ParametricNodes\n" + nodes +
                                "$EndParametricNodes\n" + elements);
    CHECK(file.tetrahedra().points() == std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    CHECK_THROWS_WITH_AS(read_gmsh("$NOD\n1\n1 0 0 0\n$ENDNOD\n$ELM\n0\n$ENDELM\n"),
                         doctest::Contains("version 1 of the format is not read; save as 2.2 or 4.1"), io::io_error);
}

TEST_CASE("gmsh: errors tell the line, or the byte, and the remedy")
{
    const auto s = test::small_volume(false);
    const std::string text = test::gmsh2_text(s, {}), fourth = test::gmsh4_text(s, {});
    const auto refuses = [](const std::string& bytes, const char* message)
    { CHECK_THROWS_WITH_AS(read_gmsh(bytes), doctest::Contains(message), io::io_error); };
    refuses("x", "there is no $MeshFormat");
    refuses("", "the file is empty; save the mesh again");
    refuses(replace_once(text, "2.2 0 8", "4.0 0 8"),
            "line 2: version 4.0 of the format is not read; save as 2.2 or 4.1");
    refuses(replace_once(text, "2.2 0 8", "2.2 0 4"), "numbers of 4 bytes");
    refuses(replace_once(text, "$EndElements", ""), "no $EndElements behind this");
    refuses(replace_once(text, "\n2 4 2 1", "\n2 11 2 1"), "element type 11 is not one of first order");
    refuses(replace_once(text, "\n2 4 2 1 41", "\n2 4 4 1 41 1 5"), "a mesh in partitions");
    refuses(replace_once(text, "\n117 ", "\n120 "), "two points have the number 120");
    refuses(replace_once(text, "\n117 ", "\n118 "), "no point has the number 117");
    refuses(replace_once(text, "$Nodes\n5", "$Nodes\n5000000"), "more than the rest of the file can hold");
    refuses(replace_once(text, "$Nodes", "$Knots"), "no $EndKnots");
    refuses("$" + std::string(1000, 'x') + "\n" + text, "line 1: the name of a section has 1000 letters");
    refuses(replace_once(text, "$Elements\n3", "$Elements\n2"), "$Elements does not end here, where its counts say");
    refuses(replace_once(fourth, "$EndEntities\n", "$EndEntities\n$PartitionedEntities\n$EndPartitionedEntities\n"),
            "save it without them");
    refuses(replace_once(fourth, "$Entities\n0 0 1 2", "$Entities\n0 0 1 1"),
            "$Entities does not end here, where its counts say");
    refuses(replace_once(fourth, "0 0 0 0.5", "nan 0 0 0.5"), "point 0 has a coordinate that is not finite");
    const std::string binary = test::gmsh2_text(s, {.text = false});
    refuses(replace_once(binary, std::string("\1\0\0\0", 4), "abcd"), "order of bytes");
}

} // namespace
