// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <set>

#include <picture/render_picture.hpp>

#include "shapes.hpp"

using namespace taut;
using io::image;
using io::render_picture;
using io::render_style;
using io::rgb;

namespace
{

const render_style small{.width = 400, .height = 240, .samples = 2, .checks = 8};

/// Both views without the captions, compared with the background of the same height, at the left border.
int drawn(const image& picture, int from, int to)
{
    int count = 0;
    for (int y = 30; y < picture.height() - 30; ++y)
        for (int x = from; x < to; ++x) count += picture(x, y) == picture(0, y) ? 0 : 1;
    return count;
}

/// Only light squares of the outside are: the inside is a muted brown.
bool light(rgb c)
{
    return c.g > 170;
}

bool pink(rgb c)
{
    return c.r > c.g + 80 && c.b > c.g + 80;
}

} // namespace

TEST_CASE("render: both views show the surface, the back its brown inside")
{
    const grid_mesh m(8);
    const image picture = render_picture(m.points, m.cells, m.uv, small);
    CHECK(drawn(picture, 0, 200) > 4000);
    CHECK(drawn(picture, 200, 400) > 4000);
    int front = 0, back = 0;
    for (int y = 30; y < 210; ++y)
        for (int x = 0; x < 200; ++x)
        {
            if (picture(x, y) != picture(0, y)) front += light(picture(x, y));
            if (picture(x + 200, y) != picture(0, y)) back += light(picture(x + 200, y));
        }
    CHECK(front > 1500);
    CHECK(back < front / 10);
}

TEST_CASE("render: an inside-out surface swaps front and back")
{
    grid_mesh m(8);
    for (auto& cell : m.cells) std::swap(cell[0], cell[1]);
    for (vec2& p : m.uv) p.x = -p.x; // keep the map unflipped
    const io::orientation guess = io::guess_orientation(m.points, m.cells);
    CHECK(guess.front == vec3(0, 0, -1));
    CHECK(io::guess_orientation(grid_mesh(8).points, grid_mesh(8).cells).front == vec3(0, 0, 1));
}

TEST_CASE("render: the checkerboard has light and dark squares of the asked size")
{
    const grid_mesh m(10);
    const io::checkerboard board(m.uv, m.cells, 5);
    CHECK(board.period() == doctest::Approx(2));
    CHECK(board.dark({1, 1}) != board.dark({3, 1}));
    CHECK(board.dark({1, 1}) != board.dark({1, 3}));
    CHECK(board.dark({1, 1}) == board.dark({3, 3}));
    CHECK(board({1, 1}) != board({5, 5})); // the tint tells places apart
    const image picture = render_picture(m.points, m.cells, m.uv, small);
    const auto lightness = [&](int x, int y) { return picture(x, y).g; };
    int least = 255, most = 0;
    for (int x = 80; x < 120; ++x)
    {
        least = std::min<int>(least, lightness(x, 120));
        most = std::max<int>(most, lightness(x, 120));
    }
    CHECK(most - least > 60);
}

TEST_CASE("render: flipped faces are magenta and none else")
{
    grid_mesh m(8);
    CHECK(count_pixels(render_picture(m.points, m.cells, m.uv, small), pink) == 0);
    std::swap(m.uv[40], m.uv[41]);
    CHECK(count_pixels(render_picture(m.points, m.cells, m.uv, small), pink) > 20);
}

TEST_CASE("render: the nearer of two faces wins, whatever their order")
{
    // Two squares facing the viewer; the near one has no map and is grey, the far one is flipped.
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    const std::vector<vec2> uv{{0, 0}, {0, 1}, {1, 0}, {nan, 0}, {nan, 0}, {nan, 0}};
    render_style style = small;
    style.turn = style.rise = 0;
    for (const cell_list& cells : {cell_list{{0, 1, 2}, {3, 4, 5}}, cell_list{{3, 4, 5}, {0, 1, 2}}})
    {
        const image picture = render_picture(points, cells, uv, style);
        int front = 0, back = 0;
        for (int y = 0; y < 240; ++y)
            for (int x = 0; x < 200; ++x)
            {
                front += pink(picture(x, y));
                back += picture(x + 200, y).r > picture(x + 200, y).g + 20;
            }
        CHECK(front == 0);
        CHECK(back > 500);
    }
}

TEST_CASE("camera: a right-handed frame of unit vectors, whatever is asked for")
{
    const vec3 zero(0);
    for (const vec3 up : {vec3(0, 1, 0), vec3(0, 0, 3), vec3(1, 1, 1), zero})
        for (const vec3 front : {vec3(0, 0, 1), vec3(0, 2, 0), vec3(-1, 0.5, 0), zero})
            for (const double turn : {0.0, 25.0, 180.0})
            {
                const io::camera c = io::turned_camera({up, front}, turn, 12);
                for (const vec3& v : {c.right, c.up, c.toward}) CHECK(glm::length(v) == doctest::Approx(1));
                CHECK(glm::length(glm::cross(c.right, c.up) - c.toward) < 1e-12);
                if (up != zero) CHECK(glm::dot(c.up, up) > 0); // up stays up
            }
    const io::camera c = io::turned_camera({}, 0, 0);
    CHECK(glm::length(c.right - vec3(1, 0, 0)) < 1e-15);
    CHECK(glm::length(c.toward - vec3(0, 0, 1)) < 1e-15);
    CHECK(glm::length(io::turned_camera({}, 180, 0).toward - vec3(0, 0, -1)) < 1e-15);
}

TEST_CASE("camera: a terrain is seen from above, an animal from its flank")
{
    grid_mesh terrain(4);
    for (std::size_t i = 0; i < terrain.points.size(); ++i)
        terrain.points[i] = vec3(terrain.uv[i].x, 0.05 * std::sin(double(i)), -terrain.uv[i].y);
    const auto above = io::guess_orientation(terrain.points, terrain.cells);
    CHECK(above.front == vec3(0, 1, 0));
    CHECK(above.up == vec3(0, 0, -1));

    // A box, long in z, narrow in x: its sides look along x.
    const std::vector<vec3> box{{0, 0, 0}, {1, 0, 0}, {1, 3, 0}, {0, 3, 0}, {0, 0, 9}, {1, 0, 9}, {1, 3, 9}, {0, 3, 9}};
    const cell_list sides{{0, 4, 7}, {0, 7, 3}, {1, 2, 6}, {1, 6, 5}, {3, 7, 6}, {3, 6, 2},
                          {0, 1, 5}, {0, 5, 4}, {4, 5, 6}, {4, 6, 7}, {0, 3, 2}, {0, 2, 1}};
    CHECK(io::guess_orientation(box, sides).front == vec3(1, 0, 0));
    CHECK(io::guess_orientation(box, sides).up == vec3(0, 1, 0));
}

TEST_CASE("render: the same input gives the same picture")
{
    const grid_mesh m(6);
    CHECK(render_picture(m.points, m.cells, m.uv, small) == render_picture(m.points, m.cells, m.uv, small));
}

TEST_CASE("render: draws what is finite and never fails on the rest")
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const grid_mesh m(4);
    auto points = m.points;
    for (const double bad : {nan, std::numeric_limits<double>::infinity(), 1e200})
    {
        points[0].y = bad;
        CHECK(drawn(render_picture(points, m.cells, m.uv, small), 0, 200) > 1000);
    }
    auto cells = m.cells;
    cells[0][0] = -1;
    cells[1][1] = 1000;
    CHECK(drawn(render_picture(m.points, cells, m.uv, small), 0, 200) > 1000);
    CHECK(drawn(render_picture(m.points, m.cells, {}, small), 0, 200) > 1000);
    CHECK(drawn(render_picture(m.points, m.cells, std::vector<vec2>(25, vec2(nan)), small), 0, 200) > 1000);
    CHECK(drawn(render_picture(m.points, m.cells, std::vector<vec2>(25, vec2(1)), small), 0, 200) > 1000);
    const image none = render_picture({}, {}, {}, small);
    CHECK(drawn(none, 0, 400) == 0);
    CHECK(drawn(render_picture(std::vector<vec3>(25, vec3(2)), m.cells, m.uv, small), 0, 400) == 0);
    CHECK_NOTHROW(render_picture(m.points, m.cells, m.uv, {.width = 1, .height = 1}));
    CHECK_THROWS_AS(render_picture(m.points, m.cells, m.uv, {.checks = 0}), parameter_error);
}
