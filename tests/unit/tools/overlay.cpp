// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <limits>

#include <picture/layout_picture.hpp>
#include <picture/layout_svg.hpp>
#include <picture/side_by_side_svg.hpp>

#include "shapes.hpp"
#include "xml.hpp"

using namespace taut;
using io::layout_overlay;
using io::pin_color;
using io::rgb;

namespace
{

const io::layout_style small{.width = 600, .height = 450, .samples = 2, .most_edges = 0};

rgb pixel(const io::image& picture, const vec2& at)
{
    return picture(static_cast<int>(at.x), static_cast<int>(at.y));
}

int occurrences(std::string_view text, std::string_view part)
{
    int count = 0;
    for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

} // namespace

TEST_CASE("overlay: hard pins are filled, springs hollow, a line leads from the vertex to its target")
{
    const grid_mesh m(4);
    const layout_overlay overlay{{{{1, 1}, {1, 1}}, {{3, 1}, {3, 3}, false}, {{0, 3}, {2, 3}}}};
    const io::image picture = io::layout_picture(m.uv, m.cells, {}, m.loops, small, overlay);
    const io::layout_frame frame(m.uv, small);
    CHECK(pixel(picture, frame({1, 1})) == pin_color);
    CHECK(pixel(picture, frame({2, 3})) == pin_color);
    CHECK(pixel(picture, frame({3, 3})) == rgb{255, 255, 255});
    CHECK(pixel(picture, frame({3, 3}) + vec2(3, 0)) == pin_color); // the ring, 6 pixels wide at 1200
    // Half way along the lines it is bluer than the face.
    for (const vec2 half : {vec2(3, 2), vec2(1, 3)})
        CHECK(pixel(picture, frame(half)).r < pixel(picture, frame(half + vec2(0.3))).r - 60);

    const std::string svg = io::layout_svg(m.uv, m.cells, {}, m.loops, small, overlay);
    CHECK(xml_fault(svg) == "");
    CHECK(occurrences(svg, "<circle") == 5); // and two in the legend
    CHECK(occurrences(svg, "fill=\"#ffffff\" stroke=") == 2);
    CHECK(svg.find(">pin</text>") != std::string::npos);
    CHECK(svg.find(">spring</text>") != std::string::npos);
}

TEST_CASE("overlay: without constraints the picture is the plain one")
{
    const grid_mesh m(3);
    CHECK(io::layout_picture(m.uv, m.cells, {}, m.loops, small) ==
          io::layout_picture(m.uv, m.cells, {}, m.loops, small, layout_overlay{}));
    CHECK(io::layout_svg(m.uv, m.cells, {}, m.loops, small).find("circle") == std::string::npos);
}

TEST_CASE("overlay: a coordinate held alone is a rail along the other one")
{
    const grid_mesh m(4);
    const layout_overlay overlay{{{{2, 2}, {2, 2}, true, 1}}}; // u is held
    const io::image picture = io::layout_picture(m.uv, m.cells, {}, m.loops, small, overlay);
    const vec2 at = io::layout_frame(m.uv, small)({2, 2});
    CHECK(pixel(picture, at + vec2(0, 6)) == pin_color);
    CHECK(pixel(picture, at - vec2(0, 6)) == pin_color);
    CHECK(pixel(picture, at + vec2(6, 0)) != pin_color);
}

TEST_CASE("overlay: targets outside of the map are within the picture, those that are not finite left out")
{
    const grid_mesh m(2);
    const layout_overlay overlay{{{{0, 0}, {-3, 5}}, {{1, 1}, {std::numeric_limits<double>::quiet_NaN(), 0}}}};
    const io::image picture = io::layout_picture(m.uv, m.cells, {}, m.loops, small, overlay);
    const auto points = io::impl::with_targets(m.uv, overlay);
    CHECK(pixel(picture, io::layout_frame(points, small)({-3, 5})) == pin_color);
    CHECK(xml_fault(io::layout_svg(m.uv, m.cells, {}, m.loops, small, overlay)) == "");
}

TEST_CASE("svg: two pictures side by side are one document")
{
    const grid_mesh m(2);
    const std::vector<std::string> both(2, io::layout_svg(m.uv, m.cells, {}, m.loops, small));
    const std::string sheet = io::side_by_side_svg(both, small.width, small.height, 20);
    CHECK(xml_fault(sheet) == "");
    CHECK(sheet.find("width=\"1220\"") != std::string::npos);
    CHECK(sheet.find("<svg x=\"620\" ") != std::string::npos);
    CHECK_THROWS_AS(io::side_by_side_svg(std::vector<std::string>{"text"}, 10, 10), parameter_error);
}

TEST_CASE("overlay: branch points are magenta targets that the legend and the caption tell")
{
    const grid_mesh m(4);
    const layout_overlay overlay{.branch_points = {{2, 2}, {std::numeric_limits<double>::quiet_NaN(), 0}}};
    const auto picture = io::layout_picture(m.uv, m.cells, {}, {}, small, overlay);
    const io::layout_frame frame(m.uv, small);
    CHECK(pixel(picture, frame(vec2(2, 2))) == io::magenta);
    const auto svg = io::layout_svg(m.uv, m.cells, {}, {}, small, overlay);
    CHECK(occurrences(svg, "<circle") == 1);
    CHECK(occurrences(svg, "winds twice") == 1);
    CHECK(occurrences(svg, "2 branch points") == 1);
}
