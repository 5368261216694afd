// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>
#include <taut/errors.hpp>
#include <taut/impl/files/surface/pins.hpp>
#include <taut/surface_file.hpp>

using namespace taut;
using io::impl::parse_pins;

namespace
{

void check_refused(const std::string& text, std::size_t line, const std::string& words)
{
    CAPTURE(text);
    try
    {
        parse_pins<2>(text, "pins.csv", 50);
        FAIL("accepted");
    }
    catch (const io::io_error& e)
    {
        CHECK_MESSAGE(std::string(e.what()).find(words) != std::string::npos, e.what());
        REQUIRE(e.place());
        CHECK(e.place()->number == line);
    }
}

} // namespace

TEST_CASE("pins: hard, soft and single coordinates from CSV")
{
    const auto pins = parse_pins<2>("vertex,u,v,weight\n# corners\n0,0,0,inf\n 7 , 0.25 , -1e-3 \n\n8,,0.5\n9,1,,\n"
                                    "12,+1,2,10 # drawn gently\n8,0.75,,\n");
    REQUIRE(pins.size() == 6);
    CHECK(pins[0].hard());
    CHECK(pins[0].held == 3);
    CHECK(pins[1].vertex == 7);
    CHECK(pins[1].target == vec2(0.25, -1e-3));
    CHECK(pins[2].held == 2);
    CHECK(pins[2].target.y == 0.5);
    CHECK(pins[3].held == 1);
    CHECK(pins[4].weight == 10);
    CHECK(!pins[4].hard());
    CHECK(pins[5].held == 1); // the other coordinate of vertex 8
    CHECK(parse_pins<2>("").empty());
    CHECK(parse_pins<2>("# nothing\n").empty());
    CHECK(parse_pins<2>("\xef\xbb\xbfvertex,u,v\r\n1,2,3\r\n2,3,4").size() == 2);
    CHECK(parse_pins<2>("1,2,3\r2,3,4\r").size() == 2);

    const auto volume = parse_pins<3>("vertex,x,y,z,weight\n1,2,3,4\n2,,,5,\n3,1,1,1,0.5\n");
    CHECK(volume[0].held == 7);
    CHECK(volume[1].held == 4);
    CHECK(volume[2].weight == 0.5);
}

TEST_CASE("pins: whatever is malformed is refused with its line")
{
    check_refused("1,2\n", 1, "2 columns; write vertex,u,v[,weight]");
    check_refused("0,0,0\n1,2,3,4,5\n", 2, "5 columns");
    check_refused("0,0,0\n\n# c\none,2,3\n", 4, "number of a vertex, found 'one'");
    check_refused("1.5,2,3\n", 1, "number of a vertex");
    check_refused("1,two,3\n", 1, "a coordinate");
    check_refused("1,2 3,3\n", 1, "a coordinate");
    check_refused("1,nan,3\n", 1, "finite");
    check_refused("1,inf,3\n", 1, "finite");
    check_refused("1,1e999,3\n", 1, "a coordinate");
    check_refused("1,2,3,heavy\n", 1, "a weight");
    check_refused("1,2,3,-1\n", 1, "negative");
    check_refused("0,0,0\n1,2,3,0\n", 2, "a weight of 0");
    check_refused("1,2,3,nan\n", 1, "not a number");
    check_refused("1,,,\n", 1, "no coordinate");
    check_refused("1,2,,5\n", 1, "all coordinates");
    check_refused("-1,2,3\n", 1, "count from 0");
    check_refused("1,2,3\r\n50,2,3\r\n", 2, "vertex 50 of 50");
    check_refused("99999999999,2,3\n", 1, "number of a vertex");
    check_refused("1,2,3\n2,2,3\n1,2,3\n", 3, "already in line 1");
    check_refused("1,2,\n1,3,3\n", 2, "already in line 1");
    check_refused("vertex,weight,u,v\n1,2,3,4\n", 1, "in this order");
    check_refused("u,v,vertex\n", 1, "in this order");
    check_refused("1,2,3\nvertex,u,v\n", 2, "number of a vertex");
    CHECK_THROWS_AS(parse_pins<2>(std::string("1,2,3\0", 6)), io::io_error);
}

TEST_CASE("pins: a planar mesh in space has z behind x and y, which is that of its plane")
{
    const auto read = [](const std::string& text, double plane) { return parse_pins<2>(text, "pins.csv", 50, plane); };
    for (const std::string header : {"", "vertex,x,y,z\n", "vertex,x,y,z,weight\n"})
    {
        const auto pins = read(header + "0,0.5,1,5\n1,2,3,5,10\n2,,1,\n3,1,,5.0\n4,2,3\n", 5);
        REQUIRE(pins.size() == 5);
        CHECK(pins[0].hard());
        CHECK(pins[0].target == vec2(0.5, 1));
        CHECK(pins[1].weight == 10);
        CHECK(pins[1].target == vec2(2, 3));
        CHECK(pins[2].held == 2);
        CHECK(pins[3].held == 1);
        CHECK(pins[4].held == 3);
    }
    CHECK(read("1,0,0,0\n", 0)[0].hard());
    CHECK(read("1,0,0,0.1\n", double(0.1F))[0].hard()); // digits of single precision
    // A first line that says so: the fourth column is a weight.
    for (const std::string header : {"vertex,u,v,weight\n", "vertex,x,y,weight\n"})
        CHECK(read(header + "1,0,0,3\n", 5)[0].weight == 3);
    const auto refused = [&](const std::string& text, double plane)
    { CHECK_THROWS_WITH_AS(read(text, plane), doctest::Contains("plane z = "), io::io_error); };
    refused("0,0,0,5\n1,0,0,4\n", 5);
    refused("1,0,0,10\n", 0);
    refused("1,0,0,1,10\n", 0);
    CHECK_THROWS_WITH_AS(read("vertex,x,z,y\n", 0), doctest::Contains("in this order"), io::io_error);
    CHECK_THROWS_WITH_AS(read("1,2,3,0,4,5\n", 0), doctest::Contains("vertex,x,y[,z][,weight]"), io::io_error);
}

TEST_CASE("pins: what is written is read back bit for bit")
{
    test::temporary_folder folder;
    const std::vector<io::pin<2>> pins{{0, 3, {0.1, -1.0 / 3}}, {5, 2, {0, 5e-324}}, {7, 3, {1e300, 2}, 0.7}};
    io::write_pins<2>(folder / "pins.csv", pins);
    const auto again = io::read_pins<2>(folder / "pins.csv", 8);
    REQUIRE(again.size() == pins.size());
    for (std::size_t i = 0; i < pins.size(); ++i)
    {
        CHECK(again[i].vertex == pins[i].vertex);
        CHECK(again[i].held == pins[i].held);
        CHECK(again[i].target == pins[i].target);
        CHECK(again[i].weight == pins[i].weight);
    }
    CHECK_THROWS_AS(io::read_pins<2>(folder / "none.csv"), io::io_error);
}
