// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>

#include <doctest/doctest.h>
#include <picture/volume_picture.hpp>

using namespace taut;
using io::image;
using io::volume_picture;

namespace
{

const io::volume_style small_volume{.width = 440, .height = 304, .samples = 2};

/// A square that faces the viewer of the front (-y), and one that is behind it.
io::volume_view squares(double distortion)
{
    return {{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {0, 1, 0}, {1, 1, 0}, {1, 1, 1}},
            {{{0, 1, 2, 3}, distortion}, {{4, 5, 6, -1}, 1, true}},
            "a title",
            "a note"};
}

bool pink(io::rgb c)
{
    return c.r > c.g + 80 && c.b > c.g + 80;
}

int count_pixels(const image& picture, int from, int to, bool (*holds)(io::rgb))
{
    int count = 0;
    for (int y = 70; y < picture.height(); ++y)
        for (int x = from; x < to; ++x) count += holds(picture(x, y)) ? 1 : 0;
    return count;
}

TEST_CASE("volume picture: views side by side, narrow ones in less room, with a legend")
{
    const auto one = volume_picture({squares(1)}, small_volume),
               two = volume_picture({squares(1), squares(8)}, small_volume);
    CHECK(one.height() == 304);
    CHECK(two.width() > one.width());
    CHECK(two.width() < 2 * one.width());
    const auto dark = [](io::rgb c) { return c.r < 150 && c.r > c.b + 40; };
    const int view = two.width() - one.width();
    CHECK(count_pixels(two, 0, view, dark) == 0);
    CHECK(count_pixels(two, view, 2 * view, dark) > 1000); // the same square, distorted
}

TEST_CASE("volume picture: what is behind is hidden, inverted cells are magenta")
{
    auto style = small_volume;
    style.turn = style.rise = 0;
    auto view = squares(1);
    const int width = volume_picture({view}, style).width() - static_cast<int>(186 * 0.4);
    CHECK(count_pixels(volume_picture({view}, style), 0, width, pink) == 0);
    view.skin.erase(view.skin.begin());
    CHECK(count_pixels(volume_picture({view}, style), 0, width, pink) > 1000);
}

TEST_CASE("volume picture: nothing to draw, flat and unknown things are no errors")
{
    CHECK(volume_picture({io::volume_view{}}, small_volume).height() == 304);
    auto view = squares(std::numeric_limits<double>::quiet_NaN());
    for (vec3& p : view.points) p = vec3(1);
    CHECK(volume_picture({view, view}, small_volume).height() == 304);
}

} // namespace
