// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <limits>

#include <picture/canvas.hpp>

#include "shapes.hpp"

using namespace taut;
using io::canvas;
using io::image;
using io::rgb;

namespace
{
constexpr rgb white{255, 255, 255}, black{0, 0, 0}, red{200, 0, 0};

double ink(const image& picture) // pixels' worth of black on white
{
    double sum = 0;
    for (const rgb c : picture.pixels()) sum += (255 - c.r) / 255.0;
    return sum;
}
} // namespace

TEST_CASE("canvas: a triangle covers the pixels inside, none outside, and part of those on its edges")
{
    canvas paper(20, 20, 4, white);
    paper.fill_triangle({2.04, 2.05}, {18.04, 2.05}, {2.04, 18.05}, black);
    const image picture = paper.resolve();
    CHECK(picture(3, 3) == black);
    CHECK(picture(1, 3) == white);
    CHECK(picture(3, 1) == white);
    CHECK(picture(15, 15) == white);
    CHECK(picture(9, 10).r > 60); // the hypotenuse cuts this pixel in half
    CHECK(picture(9, 10).r < 190);
    CHECK(ink(picture) == doctest::Approx(128).epsilon(0.02)); // area 16 * 16 / 2
}

TEST_CASE("canvas: a triangle looks the same whatever corner it starts from and however it turns")
{
    const vec2 a(1.3, 2.7), b(17.9, 5.2), c(6.6, 18.8);
    const auto draw = [](vec2 p, vec2 q, vec2 r)
    {
        canvas paper(20, 20, 3, white);
        paper.fill_triangle(p, q, r, black);
        return paper.resolve();
    };
    CHECK(draw(a, b, c) == draw(b, c, a));
    CHECK(draw(a, b, c) == draw(c, b, a));
}

TEST_CASE("canvas: triangles around a point meet without a gap and without blending a sample twice")
{
    canvas paper(40, 40, 3, white);
    constexpr int n = 17;
    const vec2 middle(20.123, 19.877);
    const auto rim = [](int i)
    {
        const double angle = 2 * std::numbers::pi * i / n;
        return vec2(20 + 100 * std::cos(angle), 20 + 100 * std::sin(angle));
    };
    for (int i = 0; i < n; ++i) paper.fill_triangle(middle, rim(i), rim(i + 1), black, 0.5);
    const image picture = paper.resolve();
    CHECK(count_pixels(picture, rgb{128, 128, 128}) == 40 * 40);
}

TEST_CASE("canvas: shapes that reach outside are clipped, shapes that are not finite left out")
{
    canvas paper(10, 10, 2, white);
    paper.fill_triangle({-1e9, -1e9}, {1e9, -1e9}, {0, 1e9}, red);
    CHECK(count_pixels(paper.resolve(), red) == 100);
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    canvas empty(10, 10, 2, white);
    empty.fill_triangle({0, 0}, {nan, 5}, {5, 9}, red);
    empty.fill_triangle({0, 0}, {inf, 5}, {5, 9}, red);
    empty.line({0, 0}, {5, nan}, 3, red);
    empty.line({-50, -50}, {-20, -80}, 3, red);
    CHECK(count_pixels(empty.resolve(), white) == 100);
}

TEST_CASE("canvas: a line has the ink of its length times its width plus its round ends")
{
    for (const vec2 to : {vec2(35, 20), vec2(20, 35), vec2(31, 33)})
    {
        canvas paper(40, 40, 8, white);
        const vec2 from(8, 9);
        paper.line(from, to, 4, black);
        const double expected = glm::length(to - from) * 4 + std::numbers::pi * 4;
        CHECK(ink(paper.resolve()) == doctest::Approx(expected).epsilon(0.02));
    }
}

TEST_CASE("canvas: a disc is filled, a ring is not")
{
    canvas paper(40, 20, 4, white);
    paper.disc({10, 10}, 7, black);
    paper.ring({30, 10}, 7, 2, black);
    const image picture = paper.resolve();
    CHECK(picture(10, 10) == black);
    CHECK(picture(10, 4) == black);
    CHECK(picture(10, 1) == white);
    CHECK(picture(30, 10) == white);
    CHECK(picture(30, 3).r < 60);
}

TEST_CASE("canvas: impossible sizes are refused by name")
{
    CHECK_THROWS_WITH_AS(canvas(0, 5, 1, white), doctest::Contains("width"), parameter_error);
    CHECK_THROWS_WITH_AS(canvas(5, -1, 1, white), doctest::Contains("height"), parameter_error);
    CHECK_THROWS_WITH_AS(canvas(5, 5, 0, white), doctest::Contains("samples"), parameter_error);
    CHECK_THROWS_WITH_AS(canvas(10000, 5, 3, white), doctest::Contains("width"), parameter_error);
}

TEST_CASE("image: pictures stand side by side in order, with a white gap")
{
    const image pair = io::side_by_side({image(3, 2, red), image(2, 4, black)}, 1);
    CHECK(pair.width() == 6);
    CHECK(pair.height() == 4);
    CHECK(count_pixels(pair, red) == 6);
    CHECK(count_pixels(pair, black) == 8);
    CHECK(pair(2, 1) == red);
    CHECK(pair(3, 1) == white);
    CHECK(pair(4, 3) == black);
    CHECK(pair(2, 3) == white);
}
