// SPDX-License-Identifier: MIT
#include <string>

#include <doctest/doctest.h>

#include <shared/tile_names.hpp>
#include <support/temporary_folder.hpp>

using namespace taut::tools;

TEST_CASE("tile names: the files of tiles are those that are there, and a name without a place for a number has none")
{
    const taut::test::temporary_folder folder;
    folder.write(folder / "one.png", "1");
    folder.write(folder / "some.1001.png", "1");
    folder.write(folder / "some.1012.png", "1");
    CHECK(tile_files((folder / "one.png").string()).empty());
    const auto some = tile_files((folder / "some.<UDIM>.png").string());
    REQUIRE(some.size() == 2);
    CHECK(some[0] == folder / "some.1001.png");
    CHECK(some[1] == folder / "some.1012.png");
    CHECK(path_of_tile("a.<UDIM>.png", 11) == "a.1012.png");
    CHECK(is_tile_file("/a.<UDIM>.png", "/a.1999.png"));
    CHECK_FALSE(is_tile_file("/a.<UDIM>.png", "/a.199.png"));
    CHECK_FALSE(is_tile_file("/a.png", "/a.png"));
}
