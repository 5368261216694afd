// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <limits>

#include <picture/layout_svg.hpp>

#include "shapes.hpp"
#include "xml.hpp"

using namespace taut;
using io::layout_svg;

namespace
{

int occurrences(std::string_view text, std::string_view part)
{
    int count = 0;
    for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

} // namespace

TEST_CASE("xml checker: finds the faults it is for")
{
    CHECK(xml_fault("<a b=\"1\"><c/>x</a>\n").empty());
    CHECK(!xml_fault("<a><b></a></b>").empty());
    CHECK(!xml_fault("<a>").empty());
    CHECK(!xml_fault("<a>&</a>").empty());
    CHECK(!xml_fault("<a b=\"1\" b=\"2\"/>").empty());
    CHECK(!xml_fault("<a b=1/>").empty());
    CHECK(!xml_fault("<a/><b/>").empty());
    CHECK(!xml_fault("").empty());
}

TEST_CASE("svg: well formed, with a path for each colour, the legend and the words")
{
    const grid_mesh m(3);
    std::vector<double> distortion(m.cells.size(), 1.0);
    distortion[3] = 10;
    const std::string svg =
        layout_svg(m.uv, m.cells, distortion, m.loops, {.title = "R&D <map> \"1\"", .energy = 7.446, .note = "a\x01"});
    CHECK(xml_fault(svg) == "");
    CHECK(svg.find(">R&amp;D &lt;map&gt; \"1\"</text>") != std::string::npos);
    CHECK(svg.find("18 faces, 0 flipped, energy 7.446") != std::string::npos);
    CHECK(svg.find(">10+</text>") != std::string::npos);
    CHECK(svg.find(">a?</text>") != std::string::npos);
    CHECK(svg.find("linearGradient") != std::string::npos);
    CHECK(occurrences(svg, "<path") == 4);                         // two colours, the edges, the boundary
    CHECK(occurrences(svg, "zm") + occurrences(svg, "z\"") == 18); // every triangle closes
    CHECK(layout_svg(m.uv, m.cells, distortion, m.loops) == layout_svg(m.uv, m.cells, distortion, m.loops));
}

TEST_CASE("svg: magenta appears exactly when a face is flipped")
{
    grid_mesh m(3);
    const std::vector<double> distortion(m.cells.size(), 1.0);
    CHECK(layout_svg(m.uv, m.cells, distortion, m.loops).find("#ff00ff") == std::string::npos);
    std::swap(m.cells[0][0], m.cells[0][1]);
    const std::string svg = layout_svg(m.uv, m.cells, distortion, m.loops);
    CHECK(svg.find("#ff00ff") != std::string::npos);
    CHECK(svg.find(">flipped</text>") != std::string::npos);
    CHECK(xml_fault(svg) == "");
}

TEST_CASE("svg: relative coordinates lead to the corners of a triangle")
{
    const std::vector<vec2> uv{{0, 0}, {4, 0}, {0, 3}};
    const io::layout_style style{.most_edges = 0};
    const std::string svg = layout_svg(uv, cell_list{{0, 1, 2}}, {}, {}, style);
    const io::layout_frame frame(uv, style);
    const auto tenth = [](double x) { return std::llround(10 * x); };
    const vec2 a = frame(uv[0]);
    const auto width = tenth(frame(uv[1]).x) - tenth(a.x), height = tenth(frame(uv[2]).y) - tenth(a.y);
    const std::string path = "d=\"m" + std::to_string(tenth(a.x)) + " " + std::to_string(tenth(a.y)) + "l" +
                             std::to_string(width) + " 0l" + std::to_string(-width) + std::to_string(height) + "z\"";
    CHECK(height < 0);
    CHECK_MESSAGE(svg.find(path) != std::string::npos, path);
}

TEST_CASE("svg: degenerate input gives a document all the same")
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const grid_mesh m(2);
    const std::vector<double> distortion(m.cells.size(), nan);
    CHECK(xml_fault(layout_svg({}, {}, {}, {})) == "");
    CHECK(xml_fault(layout_svg(std::vector<vec2>(9, vec2(nan)), m.cells, distortion, m.loops)) == "");
    CHECK(xml_fault(layout_svg(std::vector<vec2>(9, vec2(1e200)), m.cells, distortion, m.loops)) == "");
    CHECK(xml_fault(layout_svg(std::vector<vec2>(9, vec2(5)), m.cells, distortion, m.loops)) == "");
    const std::string unknown = layout_svg(m.uv, m.cells, distortion, m.loops);
    CHECK(unknown.find("#b2b2b2") != std::string::npos);
    CHECK(unknown.find("nan") == std::string::npos);
}
