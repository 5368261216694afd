// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <picture/checker.hpp>
#include <picture/palette.hpp>
#include <picture/text.hpp>
#include <picture/visibility.hpp>

namespace taut::io
{

/// Style of a rendering. The defaults suit a README.
struct render_style
{
    int width = 1600; ///< pixels, [1, 16384 / samples]; half of it for each view
    int height = 900; ///< pixels, [1, 16384 / samples]
    int samples = 3;  ///< antialiasing: samples^2 colours a pixel, [1, 8]

    palette colors = wished_palette();

    std::string title = {}; ///< first line, top left
    double checks = 40;     ///< squares along a side of a square with the area of the map, > 0

    std::optional<vec3> up = {};    ///< what is up in the model; a guess if not given (see guess_orientation)
    std::optional<vec3> front = {}; ///< from the model to the viewer of the front; a guess if not given
    double turn = 25;               ///< degrees to the side, so that the views show depth
    double rise = 12;               ///< degrees from above
};

namespace impl
{

/// Unit normals of the vertices, each the mean of its faces by area; 0 where there is none.
inline std::vector<vec3> vertex_normals(std::span<const vec3> points, std::span<const std::array<idx, 3>> cells)
{
    std::vector<vec3> normals(points.size(), vec3(0));
    for (const auto& cell : cells)
        if (drawable(points, cell))
            for (const idx v : cell) normals[static_cast<std::size_t>(v)] += area_vector(points, cell);
    for (vec3& n : normals)
    {
        const double length = glm::length(n);
        n = length > 0 && std::isfinite(length) ? n / length : vec3(0);
    }
    return normals;
}

/// Light on a surface with the unit normal n in the camera's frame, n.z >= 0: a headlight, a softer light from above
/// left, and a rim that lifts the outline off what lies behind it. Linear light.
inline vec3 shade(const vec3& albedo, const vec3& n)
{
    const vec3 above = glm::normalize(vec3(-0.45, 0.75, 0.5));
    const double head = n.z, key = std::max(0.0, glm::dot(n, above)), edge = 1 - n.z, rim = edge * edge * edge;
    const double mirror = std::max(0.0, 2 * n.z * glm::dot(n, above) - above.z), m4 = mirror * mirror * mirror * mirror;
    const double gloss = m4 * m4 * m4 * m4 * m4 * m4;
    return albedo * (0.10 + 0.48 * head + 0.52 * key) + vec3(0.10, 0.11, 0.13) * rim + vec3(0.05) * gloss;
}

/// Everything about a surface that does not depend on the view.
struct render_scene
{
    std::span<const vec3> points;
    std::span<const std::array<idx, 3>> cells;
    std::span<const vec2> uv;
    std::vector<vec3> normals;
    checkerboard board;

    /// The colour of a face at barycentric coordinates w; `inside` is seen from behind.
    vec3 color(std::size_t f, const vec3& w, const camera& eye, bool inside) const
    {
        const auto& cell = cells[f];
        const auto mix = [&](const auto& values)
        {
            return w.x * values[static_cast<std::size_t>(cell[0])] + w.y * values[static_cast<std::size_t>(cell[1])] +
                   w.z * values[static_cast<std::size_t>(cell[2])];
        };
        vec3 n = eye(mix(normals));
        if (inside) n = -n;
        n.z = std::max(n.z, 0.02); // smooth normals may turn away where the face does not
        n = glm::normalize(n);

        vec3 albedo = oklab_to_linear({0.75, 0, 0});
        if (drawable(uv, cell)) albedo = flipped(corners(uv, cell)) ? to_linear(magenta) : board(mix(uv));
        // Insides are the outside's colours, washed out to a clay brown.
        if (inside) albedo = 0.12 * albedo + 0.88 * oklab_to_linear({0.57, 0.045, 0.05});
        return shade(albedo, n);
    }
};

/// A view's picture coordinates: scale and where the middle goes, in samples.
struct view_frame
{
    camera eye;
    vec3 middle; ///< in the camera's frame
    double scale;
    vec2 centre;

    vec3 operator()(const vec3& p) const
    {
        const vec3 q = (eye(p) - middle) * scale;
        return {centre.x + q.x, centre.y - q.y, q.z};
    }
};

/// Box around the drawable faces in a camera's frame: {low, high}; low > high if there are none.
inline std::array<vec3, 2> view_box(const render_scene& scene, const camera& eye)
{
    vec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const auto& cell : scene.cells)
        if (drawable(scene.points, cell))
            for (const idx v : cell)
            {
                const vec3 p = eye(scene.points[static_cast<std::size_t>(v)]);
                low = glm::min(low, p);
                high = glm::max(high, p);
            }
    return {low, high};
}

/// Draws one view into the samples [left, left + width) of the grid.
inline void draw_view(image& grid, int left, int width, const render_scene& scene, const view_frame& frame)
{
    visibility seen(width, grid.height());
    const auto corners3 = [&](const std::array<idx, 3>& cell)
    {
        const auto at = [&](std::size_t i) { return frame(scene.points[static_cast<std::size_t>(cell[i])]); };
        return std::array<vec3, 3>{at(0), at(1), at(2)};
    };
    for (std::size_t f = 0; f < scene.cells.size(); ++f)
        if (drawable(scene.points, scene.cells[f])) seen.draw(static_cast<std::int32_t>(f), corners3(scene.cells[f]));

    const rgb_encoder encode;
    for (int y = 0; y < seen.height(); ++y)
        for (int x = 0; x < width; ++x)
        {
            const std::int32_t face = seen.face(x, y);
            if (face == visibility::nothing) continue;
            const auto f = static_cast<std::size_t>(face);
            const auto t = corners3(scene.cells[f]);
            // y points down here: a face seen from outside is clockwise.
            const bool inside = (t[1].x - t[0].x) * (t[2].y - t[0].y) > (t[1].y - t[0].y) * (t[2].x - t[0].x);
            grid(left + x, y) = encode(scene.color(f, visibility::weights(t, x, y), frame.eye, inside));
        }
}

} // namespace impl

/// A shaded picture of a surface with the checkerboard of its UV map on it: front and back side by side, at one scale,
/// orthographic. Insides of open surfaces are brown, flipped faces magenta.
///
/// points: position of each vertex. cells: corners of each face, counter-clockwise from outside. uv: map of each
/// vertex; faces without a finite one are plain grey. What is not finite is left out; no input of the right shape is an
/// error. Errors: parameter_error for a style outside its limits.
inline image render_picture(std::span<const vec3> points, std::span<const std::array<idx, 3>> cells,
                            std::span<const vec2> uv, const render_style& style = {})
{
    if (!(style.checks > 0)) throw parameter_error("checks", "must be positive");
    canvas paper(style.width, style.height, style.samples, style.colors.ground);
    image& grid = paper.grid();
    for (int y = 0; y < grid.height(); ++y)
    {
        const double t = y / double(grid.height());
        const rgb c =
            to_rgb(oklab_to_linear({style.colors.lightness - style.colors.fall * t * t, -0.002, -0.006 - 0.006 * t}));
        std::fill_n(&grid(0, y), grid.width(), c);
    }

    const impl::render_scene scene{points, cells, uv, impl::vertex_normals(points, cells), {uv, cells, style.checks}};
    orientation stance = guess_orientation(points, cells);
    stance.up = style.up.value_or(stance.up);
    stance.front = style.front.value_or(stance.front);

    const double unit = std::min(style.width / 1600.0, style.height / 900.0);
    const int half = grid.width() / 2;
    const std::array eyes{turned_camera(stance, style.turn, style.rise),
                          turned_camera(stance, style.turn + 180, style.rise)};
    const std::array boxes{impl::view_box(scene, eyes[0]), impl::view_box(scene, eyes[1])};
    const vec2 room = vec2(half, grid.height()) - style.samples * unit * vec2(70, 150);
    double scale = std::numeric_limits<double>::infinity();
    for (const auto& [low, high] : boxes)
        scale = std::min({scale, room.x / (high.x - low.x), room.y / (high.y - low.y)});

    const std::array<std::string, 2> names{"front", "back"};
    for (std::size_t k = 0; k < 2; ++k)
    {
        const int left = static_cast<int>(k) * half, width = k == 0 ? half : grid.width() - half;
        if (scale > 0 && std::isfinite(scale) && width > 0)
            impl::draw_view(grid, left, width, scene,
                            {eyes[k], (boxes[k][0] + boxes[k][1]) / 2.0, scale, vec2(width, grid.height()) / 2.0});
        draw_text(paper, vec2((left + width / 2.0) / style.samples, style.height - 30 * unit), names[k],
                  {.size = 20 * unit, .color = style.colors.soft_ink, .at = anchor::middle});
    }
    draw_text(paper, vec2(36, 52) * unit, style.title, {.size = 28 * unit, .weight = 0.1, .color = style.colors.ink});
    return paper.resolve();
}

} // namespace taut::io
