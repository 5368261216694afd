// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <limits>

#include <picture/layout_picture.hpp>
#include <picture/symmetric_distortion.hpp>

#include "shapes.hpp"

using namespace taut;
using io::image;
using io::layout_picture;
using io::layout_style;
using io::magenta;
using io::rgb;

namespace
{

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
const layout_style small{.width = 600, .height = 450, .samples = 2, .title = "test", .most_edges = 0};

rgb pixel(const image& picture, const vec2& at)
{
    return picture(static_cast<int>(at.x), static_cast<int>(at.y));
}

} // namespace

TEST_CASE("layout: each face has the colour of its distortion")
{
    const grid_mesh m(2);
    const std::vector<double> distortion{1, 1.5, 2, 3, 5, 7, 10, 1000};
    const image picture = layout_picture(m.uv, m.cells, distortion, m.loops, small);
    const io::layout_frame frame(m.uv, small);
    const io::distortion_scale scale;
    for (std::size_t f = 0; f < m.cells.size(); ++f)
    {
        vec2 middle(0);
        for (const taut::idx v : m.cells[f]) middle += m.uv[static_cast<std::size_t>(v)] / 3.0;
        CHECK(pixel(picture, frame(middle)) == scale(distortion[f]));
    }
}

TEST_CASE("layout: magenta appears exactly when a face is flipped")
{
    grid_mesh m(8);
    const std::vector<double> distortion(m.cells.size(), 1.2);
    CHECK(count_pixels(layout_picture(m.uv, m.cells, distortion, m.loops, small), magenta) == 0);

    std::swap(m.cells[5][0], m.cells[5][1]);
    const image picture = layout_picture(m.uv, m.cells, distortion, m.loops, small);
    const io::layout_frame frame(m.uv, small);
    vec2 middle(0);
    for (const taut::idx v : m.cells[5]) middle += m.uv[static_cast<std::size_t>(v)] / 3.0;
    CHECK(pixel(picture, frame(middle)) == magenta);
    CHECK(pixel(picture, (frame.bar_low + frame.bar_high) / 2.0) != magenta);
    // The legend says what it means, and only then.
    const vec2 swatch = frame.bar_high + vec2(-10, 34) * frame.unit;
    CHECK(pixel(picture, swatch) == magenta);
    const auto clean = grid_mesh(8);
    CHECK(pixel(layout_picture(clean.uv, clean.cells, distortion, clean.loops, small), swatch) == rgb{255, 255, 255});
}

TEST_CASE("layout: a face of no area counts as flipped and shows, however small")
{
    grid_mesh m(4);
    m.cells.push_back({0, 6, 12}); // on a diagonal: determinant 0
    std::vector<double> distortion(m.cells.size(), 1.0);
    CHECK(io::survey_faces(m.uv, m.cells, distortion).flipped == std::vector<std::size_t>{32});
    CHECK(count_pixels(layout_picture(m.uv, m.cells, distortion, m.loops, small), magenta) > 20);

    // A flipped speck far below a pixel is ringed.
    grid_mesh speck(4);
    const auto first = static_cast<taut::idx>(speck.uv.size());
    for (const vec2 p : {vec2(2.5, 2.2), vec2(2.5, 2.2001), vec2(2.5001, 2.2)}) speck.uv.push_back(p);
    speck.cells.push_back({first, first + 1, first + 2});
    distortion.assign(speck.cells.size(), 1.0);
    layout_style style = small;
    const int ringed = count_pixels(layout_picture(speck.uv, speck.cells, distortion, speck.loops, style), magenta);
    style.most_rings = 0;
    const int bare = count_pixels(layout_picture(speck.uv, speck.cells, distortion, speck.loops, style), magenta);
    CHECK(bare > 0);
    CHECK(ringed > bare + 10);
}

TEST_CASE("layout: flips lie on top of faces drawn later")
{
    const std::vector<vec2> uv{{0, 0}, {1, 0}, {0, 1}};
    const cell_list cells{{0, 2, 1}, {0, 1, 2}};
    const image picture = layout_picture(uv, cells, std::vector<double>{1, 1}, {}, small);
    CHECK(pixel(picture, io::layout_frame(uv, small)({0.3, 0.3})) == magenta);
}

TEST_CASE("layout: the legend runs from the lowest colour at the bottom to the highest at the top")
{
    const grid_mesh m(2);
    const std::vector<double> distortion(m.cells.size(), 1.0);
    const image picture = layout_picture(m.uv, m.cells, distortion, m.loops, small);
    const io::layout_frame frame(m.uv, small);
    const io::distortion_scale scale;
    const double x = (frame.bar_low.x + frame.bar_high.x) / 2;
    CHECK(pixel(picture, {x, frame.bar_high.y - 1}) == scale.at(0));
    const rgb top = pixel(picture, {x, frame.bar_low.y + 1});
    CHECK(std::abs(top.r - scale.at(1).r) <= 4);
    CHECK(std::abs(top.g - scale.at(1).g) <= 4);
    // Words next to it: dark pixels to the right of the bar.
    int dark = 0;
    for (int y = 0; y < picture.height(); ++y)
        for (int i = static_cast<int>(frame.bar_high.x) + 6; i < picture.width(); ++i) dark += picture(i, y).r < 128;
    CHECK(dark > 50);
    CHECK(io::impl::scale_ticks(scale) == std::vector<double>{1, 1.5, 2, 3, 5, 7, 10});
    CHECK(io::impl::scale_ticks(io::distortion_scale(0.1, 1000)).front() == 0.1);
    CHECK(io::impl::scale_ticks(io::distortion_scale(0.1, 1000)).back() == 1000);
}

TEST_CASE("layout: the boundary is dark, the inside without edges is not")
{
    const grid_mesh m(2);
    const std::vector<double> distortion(m.cells.size(), 1.0);
    layout_style style = small;
    const io::layout_frame frame(m.uv, style);
    const image picture = layout_picture(m.uv, m.cells, distortion, m.loops, style);
    CHECK(pixel(picture, frame({0.5, 0})).r < 160);
    CHECK(pixel(picture, frame({0, 1.5})).r < 160);
    CHECK(pixel(picture, frame({1, 0.5})) == io::distortion_scale().at(0));
    CHECK(pixel(layout_picture(m.uv, m.cells, distortion, {}, style), frame({0.5, 0.01})) ==
          io::distortion_scale().at(0));
    style.most_edges = 5000;
    CHECK(pixel(layout_picture(m.uv, m.cells, distortion, m.loops, style), frame({1, 0.5})) !=
          io::distortion_scale().at(0));
}

TEST_CASE("layout: v points up and the aspect ratio is kept")
{
    const std::vector<vec2> uv{{0, 0}, {10, 0}, {0, 1}};
    const io::layout_frame frame(uv, small);
    CHECK(frame({0, 1}).y < frame({0, 0}).y);
    CHECK(frame({1, 0}).x - frame({0, 0}).x == doctest::Approx(frame({0, 0}).y - frame({0, 1}).y));
    for (const vec2& p : uv)
    {
        CHECK(frame(p).x >= frame.plot_low.x - 1e-9);
        CHECK(frame(p).x <= frame.plot_high.x + 1e-9);
        CHECK(frame(p).y >= frame.plot_low.y - 1e-9);
        CHECK(frame(p).y <= frame.plot_high.y + 1e-9);
    }
}

TEST_CASE("layout: the caption counts")
{
    grid_mesh m(3);
    std::swap(m.cells[0][0], m.cells[0][1]);
    m.cells[1][2] = 99; // does not exist
    const std::vector<double> distortion(m.cells.size(), 2.0);
    const auto faces = io::survey_faces(m.uv, m.cells, distortion);
    layout_style style;
    style.energy = 4.5;
    CHECK(io::impl::layout_caption(faces, style, {}) ==
          "18 faces, 1 flipped, energy 4.5, 1 not finite  |  distortion: median 2, 99 % below 2, largest 2");
    const io::layout_overlay overlay{.branch_points = {vec2(0.5), vec2(0.25)}};
    CHECK(io::impl::layout_caption(faces, style, overlay).starts_with("18 faces, 1 flipped, 2 branch points, energy"));
    style.census = "9 quads, 0 inverted"; // faces are halves of them
    CHECK(io::impl::layout_caption(faces, style, overlay).starts_with("9 quads, 0 inverted, 2 branch points, energy"));
}

TEST_CASE("layout: the same input gives the same picture")
{
    const grid_mesh m(5);
    const std::vector<double> distortion(m.cells.size(), 2.0);
    CHECK(layout_picture(m.uv, m.cells, distortion, m.loops) == layout_picture(m.uv, m.cells, distortion, m.loops));
}

TEST_CASE("layout: draws what is finite and never fails on the rest")
{
    grid_mesh m(3);
    const std::vector<double> distortion(m.cells.size(), 1.0);
    for (const double bad : {not_a_number, infinity, -infinity, 1e300})
    {
        auto uv = m.uv;
        uv[0].x = bad;
        const auto faces = io::survey_faces(uv, m.cells, distortion);
        CHECK(faces.undrawable == 2);
        CHECK(faces.flipped.empty());
        const image picture = layout_picture(uv, m.cells, distortion, m.loops, small);
        CHECK(pixel(picture, io::layout_frame(uv, small)({2.3, 2.1})) == io::distortion_scale().at(0));
    }
    const std::vector<vec2> same(m.uv.size(), vec2(3, 4)), none(m.uv.size(), vec2(not_a_number));
    CHECK(count_pixels(layout_picture(same, m.cells, distortion, m.loops, small), magenta) > 0);
    CHECK(count_pixels(layout_picture(none, m.cells, distortion, m.loops, small), magenta) == 0);
    CHECK_NOTHROW(layout_picture({}, {}, {}, {}, small));
    CHECK_NOTHROW(layout_picture(m.uv, m.cells, {}, {{0, 1, 77, -3}, {}}, small));
    const std::vector<double> odd(m.cells.size(), not_a_number);
    CHECK(count_pixels(layout_picture(m.uv, m.cells, odd, m.loops, small), io::distortion_scale::unknown) > 1000);
    CHECK_NOTHROW(layout_picture(m.uv, m.cells, distortion, m.loops, {.width = 7, .height = 3}));
}

TEST_CASE("layout: a wrong number of distortions is refused by name")
{
    const grid_mesh m(2);
    CHECK_THROWS_WITH_AS(layout_picture(m.uv, m.cells, std::vector<double>{1, 2}, m.loops),
                         doctest::Contains("distortion"), parameter_error);
}

TEST_CASE("symmetric distortion: stretch, shrink, shear, isometry and flat faces")
{
    const std::vector<vec3> points{{1, 1, 1}, {1, 3, 1}, {1, 1, 5}};
    const cell_list cells{{0, 1, 2}};
    const auto of = [&](vec2 a, vec2 b, vec2 c) {
        return io::symmetric_distortion(points, cells, std::vector<vec2>{a, b, c})[0];
    };
    CHECK(of({7, 7}, {9, 7}, {7, 11}) == doctest::Approx(1));  // an isometry
    CHECK(of({7, 7}, {7, 9}, {11, 7}) == doctest::Approx(1));  // a mirror image: only the sign differs
    CHECK(of({0, 0}, {6, 0}, {0, 12}) == doctest::Approx(3));  // three times as large
    CHECK(of({0, 0}, {0.5, 0}, {0, 1}) == doctest::Approx(4)); // a quarter
    CHECK(of({0, 0}, {4, 0}, {0, 1}) == doctest::Approx(4));   // twice and a quarter
    CHECK(of({0, 0}, {2, 0}, {4, 4}) == doctest::Approx((1 + std::sqrt(5)) / 2)); // shear by 1: the golden ratio
    CHECK(of({0, 0}, {1, 0}, {2, 0}) > 1e15);
    CHECK(std::isnan(of({0, 0}, {not_a_number, 0}, {2, 0})));
    CHECK(std::isnan(io::symmetric_distortion(std::vector<vec3>(3, vec3(1)), cells, std::vector<vec2>(3))[0]));
    CHECK(std::isnan(io::symmetric_distortion(points, cells, std::vector<vec2>(1))[0]));
}
