// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdlib>
#include <string>

#include <doctest/doctest.h>
#include <picture/layout_picture.hpp>
#include <picture/layout_svg.hpp>
#include <picture/render_picture.hpp>
#include <picture/volume_picture.hpp>

#include "shapes.hpp"

using namespace taut;
using io::dark_palette;
using io::rgb;

namespace
{

/// (L1 + 0.05) / (L2 + 0.05) of the relative luminances: WCAG 2, 1.4.3.
double contrast(rgb a, rgb b)
{
    const auto luminance = [](rgb c) { return glm::dot(io::to_linear(c), vec3(0.2126, 0.7152, 0.0722)) + 0.05; };
    const double x = luminance(a), y = luminance(b);
    return std::max(x, y) / std::min(x, y);
}

} // namespace

TEST_CASE("palette: words and pins are read on both grounds")
{
    for (const io::palette& colors : {io::palette{}, dark_palette})
    {
        CHECK(contrast(colors.ink, colors.ground) > 7);
        CHECK(contrast(colors.soft_ink, colors.ground) > 4.5);
        CHECK(contrast(colors.pin, colors.ground) > 4.5);
        CHECK(contrast(io::magenta, colors.ground) > 3);
        const auto top = io::to_rgb(io::oklab_to_linear({colors.lightness, 0, 0}));
        const auto bottom = io::to_rgb(io::oklab_to_linear({colors.lightness - colors.fall, 0, 0}));
        CHECK(contrast(colors.ink, top) > 7);
        CHECK(contrast(colors.soft_ink, bottom) > 4.5);
    }
}

TEST_CASE("palette: TAUT_THEME=dark wishes the dark one, anything else the light one")
{
    const char* before = std::getenv("TAUT_THEME");
    const std::string kept = before == nullptr ? "" : before;
    ::setenv("TAUT_THEME", "dark", 1);
    CHECK(io::wished_palette() == dark_palette);
    CHECK(io::layout_style{}.colors == dark_palette);
    for (const char* theme : {"", "light", "darker"})
    {
        ::setenv("TAUT_THEME", theme, 1);
        CHECK(io::wished_palette() == io::palette{});
    }
    ::unsetenv("TAUT_THEME");
    CHECK(io::wished_palette() == io::palette{});
    if (before != nullptr) ::setenv("TAUT_THEME", kept.c_str(), 1);
}

TEST_CASE("palette: a dark layout has the colours of the light one on another ground")
{
    const grid_mesh m(2);
    const std::vector<double> distortion{1, 1.5, 2, 3, 5, 7, 10, 1000};
    io::layout_style style{.width = 600, .height = 450, .samples = 2, .colors = {}, .title = "test", .most_edges = 0};
    const auto light = io::layout_picture(m.uv, m.cells, distortion, m.loops, style);
    style.colors = dark_palette;
    const auto dark = io::layout_picture(m.uv, m.cells, distortion, m.loops, style);
    CHECK(light(0, 0) == rgb{255, 255, 255});
    CHECK(dark(0, 0) == dark_palette.ground);
    CHECK(count_pixels(dark, rgb{255, 255, 255}) == 0);
    const io::layout_frame frame(m.uv, style);
    for (const auto& cell : m.cells)
    {
        vec2 middle(0);
        for (const idx v : cell) middle += frame(m.uv[static_cast<std::size_t>(v)]) / 3.0;
        const int x = static_cast<int>(middle.x), y = static_cast<int>(middle.y);
        CHECK(light(x, y) == dark(x, y));
    }
    const auto sheet = io::side_by_side({dark, dark}, 20, dark_palette.ground);
    CHECK(sheet(610, 225) == dark_palette.ground);
}

TEST_CASE("palette: SVG has the colours of the pixels")
{
    const grid_mesh m(2);
    const io::layout_overlay pins{.pins = {{{0, 0}, {0, 0}, true}, {{1, 1}, {1, 1}, false}}};
    const auto svg = io::layout_svg(m.uv, m.cells, {}, m.loops, {.colors = dark_palette, .title = "test"}, pins);
    const auto first = svg.find("<rect");
    CHECK(svg.find("fill=\"#16191f\"", first) < svg.find("/>", first));
    CHECK(svg.find("#ffffff") == std::string::npos);
    CHECK(svg.find("#e2e6ee") != std::string::npos);
    CHECK(svg.find("#4094ff") != std::string::npos);
    CHECK(svg.find("#005ebe") == std::string::npos);
}

TEST_CASE("palette: dark renderings and volumes have a dark ground and show the same surface")
{
    const grid_mesh m(8);
    io::render_style style{.width = 400, .height = 240, .samples = 2, .colors = {}, .checks = 8};
    const auto light = io::render_picture(m.points, m.cells, m.uv, style);
    style.colors = dark_palette;
    const auto dark = io::render_picture(m.points, m.cells, m.uv, style);
    CHECK(light(0, 0).g > 240);
    CHECK(dark(0, 0).g < 50);
    int surface = 0, changed = 0; // pixels of the surface alone are the same, those of its outline are mixed
    for (int y = 30; y < 210; ++y)
        for (int x = 0; x < 400; ++x)
        {
            const bool seen = light(x, y) != light(0, y);
            surface += seen;
            changed += seen && light(x, y) != dark(x, y);
        }
    CHECK(surface > 8000);
    CHECK(changed < surface / 10);

    const io::volume_view square{{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}, {{{0, 1, 2, 3}, 1}}, "a", "b"};
    const auto volume =
        io::volume_picture({square}, {.width = 440, .height = 304, .samples = 2, .colors = dark_palette});
    CHECK(volume(0, 0) == dark_palette.ground);
    CHECK(volume(volume.width() - 1, 303) == dark_palette.ground);
    CHECK(count_pixels(volume, rgb{255, 255, 255}) == 0);
}
