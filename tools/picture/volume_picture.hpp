// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <picture/layout_picture.hpp>
#include <picture/render_picture.hpp>

namespace taut::io
{

/// A polygon that is seen of a volume.
struct skin_face
{
    std::array<idx, 4> vertices; ///< around; the last is -1 in a triangle
    double distortion = 1;       ///< NaN: not known
    bool inverted = false;       ///< its cell is; magenta
};

/// One picture of a volume.
struct volume_view
{
    std::vector<vec3> points;
    std::vector<skin_face> skin;
    std::string title, note; ///< lines above it
};

/// Style of pictures of volumes, side by side. The defaults suit a README.
struct volume_style
{
    int width = 1100; ///< largest width of a view in pixels, narrow ones take less; [1, 16384 / samples] of them all
    int height = 760; ///< pixels
    int samples = 3;  ///< antialiasing: samples^2 colours a pixel, [1, 8]

    palette colors = wished_palette();

    orientation stance{{0, 0, 1}, {0, -1, 0}}; ///< up and front of the model
    double turn = 30, rise = 20;               ///< degrees to the side of the front, and from above

    double lowest = 1, highest = 10;       ///< of the scale of colours
    std::string scale = "distortion";      ///< name of the number, over the legend
    std::string formula = "max(s1, 1/s3)"; ///< what it is, below the name
};

namespace impl
{

/// The colour of a face with the unit normal n in the camera's frame, n.z >= 0: bright enough that the scale is read.
inline vec3 lit(const vec3& albedo, const vec3& n)
{
    const vec3 above = glm::normalize(vec3(-0.45, 0.75, 0.5));
    return albedo * (0.42 + 0.34 * n.z + 0.30 * std::max(0.0, glm::dot(n, above)));
}

/// Distance of p from the segment ab.
inline double segment_distance(const vec2& p, const vec2& a, const vec2& b)
{
    const vec2 d = b - a;
    const double length2 = glm::dot(d, d), t = length2 > 0 ? std::clamp(glm::dot(p - a, d) / length2, 0.0, 1.0) : 0.0;
    return glm::length(p - a - t * d);
}

/// The skin of one view, in samples.
class drawn_skin
{
public:
    drawn_skin(const volume_view& view, const view_frame& frame) : view_(view)
    {
        for (const auto& p : view.points) places_.push_back(frame(p));
        double lengths = 0;
        std::size_t edges = 0;
        for (const auto& f : view.skin)
            for (std::size_t k = 0; k < sides(f); ++k, ++edges)
                lengths += glm::distance(vec2(corner(f, k)), vec2(corner(f, (k + 1) % sides(f))));
        mean_edge_ = edges > 0 ? lengths / static_cast<double>(edges) : 0;
    }

    /// Into samples [left, left + width) of the grid. pen: of edges, in samples.
    void draw(image& grid, int left, int width, const distortion_scale& scale, double pen) const
    {
        visibility seen(width, grid.height());
        for (std::size_t f = 0; f < view_.skin.size(); ++f)
            for (std::size_t part = 0; part + 2 < sides(view_.skin[f]); ++part)
                seen.draw(static_cast<std::int32_t>(2 * f + part), half(view_.skin[f], part));
        const bool edges = mean_edge_ > 5 * pen; // where they are closer they would hide the colours
        const rgb_encoder encode;
        for (int y = 0; y < seen.height(); ++y)
            for (int x = 0; x < width; ++x)
            {
                const std::int32_t part = seen.face(x, y);
                if (part == visibility::nothing) continue;
                const auto& f = view_.skin[static_cast<std::size_t>(part) / 2];
                vec3 color = lit(to_linear(f.inverted ? magenta : scale(f.distortion)),
                                 normal(half(f, static_cast<std::size_t>(part) % 2)));
                if (edges && near_edge(f, vec2(x + 0.5, y + 0.5), pen / 2)) color *= 0.45;
                grid(left + x, y) = encode(color);
            }
    }

private:
    static std::size_t sides(const skin_face& f) { return f.vertices[3] < 0 ? 3 : 4; }
    const vec3& corner(const skin_face& f, std::size_t k) const
    {
        return places_[static_cast<std::size_t>(f.vertices[k])];
    }
    std::array<vec3, 3> half(const skin_face& f, std::size_t part) const
    {
        return {corner(f, 0), corner(f, part + 1), corner(f, part + 2)};
    }

    /// Towards the eye; y points down in samples.
    static vec3 normal(const std::array<vec3, 3>& t)
    {
        vec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
        n.y = -n.y;
        if (n.z < 0) n = -n;
        const double length = glm::length(n);
        return length > 0 ? n / length : vec3(0, 0, 1);
    }

    bool near_edge(const skin_face& f, const vec2& p, double reach) const
    {
        for (std::size_t k = 0; k < sides(f); ++k)
            if (segment_distance(p, vec2(corner(f, k)), vec2(corner(f, (k + 1) % sides(f)))) < reach) return true;
        return false;
    }

    const volume_view& view_;
    std::vector<vec3> places_;
    double mean_edge_;
};

} // namespace impl

/// Pictures of volumes side by side, seen from one point at one scale: each face in the colour of its distortion on a
/// fixed scale with a legend, those of inverted cells in magenta, with their edges where there is room.
/// Errors: parameter_error for a style outside its limits. Coordinates are finite.
inline image volume_picture(const std::vector<volume_view>& views, const volume_style& style = {})
{
    const double unit = std::min(style.width / 1100.0, style.height / 760.0);
    const distortion_scale scale(style.lowest, style.highest);
    const camera eye = turned_camera(style.stance, style.turn, style.rise);

    vec3 low(std::numeric_limits<double>::infinity()), high(-low);
    bool inverted = false, unknown = false;
    for (const auto& view : views)
        for (const auto& f : view.skin)
        {
            inverted = inverted || f.inverted;
            unknown = unknown || (!f.inverted && std::isnan(f.distortion));
            for (const idx v : f.vertices)
                if (v >= 0)
                {
                    low = glm::min(low, eye(view.points[static_cast<std::size_t>(v)]));
                    high = glm::max(high, eye(view.points[static_cast<std::size_t>(v)]));
                }
        }
    const double top = 100 * unit, margin = 28 * unit, tall = style.height - top - margin;
    double wanted = tall * (high.x - low.x) / (high.y - low.y);
    for (const auto& view : views) wanted = std::max(wanted, text_width(view.note, 15 * unit));
    if (!std::isfinite(wanted)) wanted = style.width; // nothing to draw
    const int width = static_cast<int>(std::min(wanted + 2 * margin, double(style.width)));
    const int n = static_cast<int>(views.size()), legend = static_cast<int>(186 * unit);
    canvas paper(n * width + legend, style.height, style.samples, style.colors.ground);
    const vec2 room = vec2(width - 2 * margin, tall) * double(style.samples);
    const double fit = std::min(room.x / (high.x - low.x), room.y / (high.y - low.y));
    for (int k = 0; k < n; ++k)
    {
        const auto& view = views[static_cast<std::size_t>(k)];
        const double left = double(k) * width;
        if (fit > 0 && std::isfinite(fit))
        {
            const vec2 centre(width / 2.0, (top + style.height - margin) / 2);
            const impl::view_frame frame{eye, (low + high) / 2.0, fit, centre * double(style.samples)};
            impl::drawn_skin(view, frame)
                .draw(paper.grid(), k * width * style.samples, width * style.samples, scale,
                      std::max(1.0, 0.9 * unit * style.samples));
        }
        draw_text(paper, {left + margin, 44 * unit}, view.title,
                  {.size = 24 * unit, .weight = 0.1, .color = style.colors.ink});
        draw_text(paper, {left + margin, 72 * unit}, view.note, {.size = 15 * unit, .color = style.colors.soft_ink});
    }

    // The legend takes its place from the frame of a layout as large as the sheet.
    layout_style sheet;
    sheet.width = paper.width();
    sheet.height = style.height;
    sheet.colors = style.colors;
    sheet.scale = style.scale;
    sheet.formula = style.formula;
    layout_frame frame({}, sheet);
    frame.unit = unit;
    const double right = paper.width() - legend;
    frame.bar_low = {right + 30 * unit, 150 * unit};
    frame.bar_high = frame.bar_low + vec2(26, 380) * unit;
    face_survey survey;
    survey.unknown = unknown ? 1 : 0;
    impl::draw_legend(paper, frame, survey, scale, sheet, {});
    if (inverted)
    {
        const double y = frame.bar_high.y + (unknown ? 68 : 40) * unit;
        paper.fill_rectangle({frame.bar_low.x, y - 15 * unit}, {frame.bar_high.x, y + 3 * unit}, magenta);
        draw_text(paper, {frame.bar_high.x + 14 * unit, y}, "inverted", {.size = 17 * unit, .color = style.colors.ink});
    }
    return paper.resolve();
}

} // namespace taut::io
