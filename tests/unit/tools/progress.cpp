// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <sstream>
#include <string>
#include <vector>

#include "../../../tools/shared/progress.hpp"

using taut::tools::parse_progress_mode;
using taut::tools::progress;
using taut::tools::progress_mode;

TEST_CASE("progress: auto means a bar on a terminal and silence elsewhere")
{
    CHECK(parse_progress_mode("auto", true) == progress_mode::bar);
    CHECK(parse_progress_mode("auto", false) == progress_mode::none);
    CHECK(parse_progress_mode("json", false) == progress_mode::json);
    CHECK(parse_progress_mode("none", true) == progress_mode::none);
    CHECK(!parse_progress_mode("loud", true));
}

TEST_CASE("progress: the bar fills with the steps, and has none without a limit")
{
    CHECK(
        progress::bar_line({.phase = "optimize", .step = 12, .most_steps = 48, .energy = 7.44603, .seconds = 0.5312}) ==
        "[######..................] optimize  step 12  energy 7.446  0.53 s");
    CHECK(progress::bar_line({.phase = "start map", .step = 3}) == "start map  step 3  0 s");
    CHECK(progress::bar_line({.phase = "p", .step = 99, .most_steps = 10}).substr(0, 26) ==
          "[########################]");
}

TEST_CASE("progress: JSON has one object a line, without infinities, quotes escaped")
{
    CHECK(progress::json_line({.phase = "a\"b\\", .step = 1, .energy = 7.446, .length = 0.5, .seconds = 0.25}) ==
          R"({"phase":"a\"b\\","iteration":1,"energy":7.446,"gradient":null,"step":0.5,"seconds":0.25})");
    CHECK(progress::json_line({.energy = std::numeric_limits<double>::infinity()}).find("\"energy\":null") !=
          std::string::npos);
}

TEST_CASE("progress: tells the first and the last of each phase, and not too often in between")
{
    std::ostringstream out;
    progress p(progress_mode::json, out, 10);
    for (int i = 0; i < 100; ++i) p.update({.phase = "start", .step = i, .seconds = i * 0.001});
    p.update({.phase = "optimize", .step = 0, .seconds = 0.1001});
    p.update({.phase = "optimize", .step = 1, .seconds = 0.1002});
    p.finish();
    p.finish();
    std::istringstream lines(out.str());
    std::vector<std::string> seen;
    for (std::string line; std::getline(lines, line);) seen.push_back(line);
    REQUIRE(seen.size() == 4);
    CHECK(seen[0].find("\"start\",\"iteration\":0") != std::string::npos);
    CHECK(seen[1].find("\"start\",\"iteration\":99") != std::string::npos);
    CHECK(seen[2].find("\"optimize\",\"iteration\":0") != std::string::npos);
    CHECK(seen[3].find("\"optimize\",\"iteration\":1") != std::string::npos);
}

TEST_CASE("progress: the bar redraws its line and clears it at the end; none writes nothing")
{
    std::ostringstream out;
    {
        progress p(progress_mode::bar, out, 10);
        p.update({.phase = "a", .seconds = 0});
        p.update({.phase = "a", .step = 1, .seconds = 1});
    }
    const std::string text = out.str();
    CHECK(text.front() == '\r');
    CHECK(text.find('\n') == std::string::npos);
    CHECK(text.substr(text.size() - 4) == "\r\x1b[K");

    std::ostringstream silent;
    {
        progress p(progress_mode::none, silent);
        p.update({.phase = "a"});
    }
    CHECK(silent.str().empty());
}
