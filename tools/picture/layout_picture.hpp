// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <picture/layout_parts.hpp>
#include <picture/text.hpp>

namespace taut::io
{

namespace impl
{

inline void draw_faces(canvas& paper, const layout_frame& frame, std::span<const vec2> uv,
                       std::span<const std::array<idx, 3>> cells, std::span<const double> distortion,
                       const distortion_scale& scale)
{
    for (std::size_t f = 0; f < cells.size(); ++f)
    {
        if (!drawable(uv, cells[f])) continue;
        const auto t = corners(uv, cells[f]);
        if (flipped(t)) continue;
        const rgb color = distortion.empty() ? scale.at(0) : scale(distortion[f]);
        paper.fill_triangle(frame(t[0]), frame(t[1]), frame(t[2]), color);
    }
}

inline void draw_boundary(canvas& paper, const layout_frame& frame, std::span<const vec2> uv,
                          const std::vector<std::vector<idx>>& loops, rgb ink)
{
    for (const auto& loop : loops)
        for_each_boundary_edge(
            uv, loop, [&](const vec2& a, const vec2& b) { paper.line(frame(a), frame(b), 1.6 * frame.unit, ink); });
}

/// Flips in magenta. Each gets an outline too, or a dot if they are very many, so that it shows however small it is;
/// few are ringed, so that they are found.
inline void draw_flips(canvas& paper, const layout_frame& frame, std::span<const vec2> uv,
                       std::span<const std::array<idx, 3>> cells, const face_survey& faces, std::size_t most_rings)
{
    constexpr std::size_t most_outlines = 100'000;
    const double pen = std::max(2.0, 2.2 * frame.unit);
    for (std::size_t f : faces.flipped)
    {
        const auto t = corners(uv, cells[f]);
        const std::array<vec2, 3> p{frame(t[0]), frame(t[1]), frame(t[2])};
        paper.fill_convex(p, magenta);
        if (faces.flipped.size() <= most_outlines)
            for (std::size_t i = 0; i < 3; ++i) paper.line(p[i], p[(i + 1) % 3], pen, magenta);
        else
        {
            const vec2 middle = (p[0] + p[1] + p[2]) / 3.0;
            paper.fill_rectangle(middle - vec2(pen / 2), middle + vec2(pen / 2), magenta);
        }
        if (faces.flipped.size() > most_rings) continue;
        if (const auto centre = ring_centre(frame, t)) paper.ring(*centre, 14 * frame.unit, 2.4 * frame.unit, magenta);
    }
}

inline void draw_mark(canvas& paper, const pin_mark& mark, double unit, const palette& colors)
{
    switch (mark.form)
    {
    case pin_mark::disc:
        paper.line(mark.at, mark.at, 2 * mark.radius, colors.pin);
        break;
    case pin_mark::rail:
        paper.line(mark.low, mark.high, 0.8 * mark.radius, colors.pin);
        break;
    case pin_mark::ring:
        paper.line(mark.at, mark.at, 2 * mark.radius, colors.ground);
        paper.ring(mark.at, mark.radius, std::max(1.6 * unit, 1.0), colors.pin);
        break;
    }
}

/// Lines of displacement first, so that none runs over a pin.
inline void draw_overlay(canvas& paper, const layout_frame& frame, const layout_overlay& overlay, const palette& colors)
{
    const auto marks = pin_marks(overlay, frame, frame.unit);
    for (const auto& mark : marks)
        if (mark.moved) paper.line(mark.from, mark.at, std::max(1.4 * frame.unit, 1.0), colors.pin, 0.7);
    for (const auto& mark : marks) draw_mark(paper, mark, frame.unit, colors);
    for (const vec2& at : branch_marks(overlay, frame))
    {
        paper.line(at, at, 5 * frame.unit, magenta);
        paper.ring(at, 9 * frame.unit, std::max(2.4 * frame.unit, 1.0), magenta);
    }
}

inline void draw_legend(canvas& paper, const layout_frame& frame, const face_survey& faces,
                        const distortion_scale& scale, const layout_style& style, const layout_overlay& overlay)
{
    const double u = frame.unit;
    const vec2 low = frame.bar_low, high = frame.bar_high;
    const rgb ink = style.colors.ink;
    draw_text(paper, low - vec2(0, 46 * u), style.scale, {.size = 19 * u, .weight = 0.1, .color = ink});
    draw_text(paper, low - vec2(0, 23 * u), style.formula, {.size = 15 * u, .color = style.colors.soft_ink});

    const auto height = [&](double t) { return high.y + t * (low.y - high.y); };
    paper.fill_rectangle(low - vec2(u), high + vec2(u), ink);
    for (int k = 0; k < distortion_scale::colors; ++k)
        paper.fill_rectangle(vec2(low.x, height(k / double(distortion_scale::colors))),
                             vec2(high.x, height((k + 1) / double(distortion_scale::colors))),
                             scale.at(k / double(distortion_scale::colors - 1)));
    for (double tick : scale_ticks(scale))
    {
        const double y = height(scale.position(tick));
        paper.line({high.x + u, y}, {high.x + 7 * u, y}, 1.4 * u, ink);
        draw_text(paper, {high.x + 14 * u, y + 6 * u}, tick_label(scale, tick), {.size = 17 * u, .color = ink});
    }

    double y = high.y + 40 * u;
    for (const auto& [color, text] : legend_entries(faces, overlay))
    {
        paper.fill_rectangle(vec2(low.x, y - 15 * u), vec2(high.x, y + 3 * u), color);
        draw_text(paper, {high.x + 14 * u, y}, text, {.size = 17 * u, .color = ink});
        y += 28 * u;
    }
    for (const auto& [hard, text] : pin_legend(overlay))
    {
        const vec2 at((low.x + high.x) / 2, y - 6 * u);
        draw_mark(paper, {hard ? pin_mark::disc : pin_mark::ring, at, at, at, at, false, 6 * u}, u, style.colors);
        draw_text(paper, {high.x + 14 * u, y}, text, {.size = 17 * u, .color = ink});
        y += 28 * u;
    }
}

} // namespace impl

/// A picture of a UV layout: every face in the colour of its distortion on a fixed scale with a legend, flipped faces
/// in magenta on top, the boundary in ink, triangle edges if there are few.
///
/// uv: position of each vertex; v points up. cells: corners of each face. distortion: one number a face (see
/// symmetric_distortion), or empty to draw plain faces. boundary_loops: closed vertex loops (see boundary_loops).
/// A face is flipped when its determinant in uv, in double precision, is not positive. What is not finite is left out
/// and counted in the caption; no input of the right shape is an error. overlay: constraints, drawn on top: pins
/// filled, springs hollow, each at its target with a line from where its vertex is, branch points as magenta targets.
/// Errors: parameter_error for a wrong number of distortions or a style outside its limits.
inline image layout_picture(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells,
                            std::span<const double> distortion, const std::vector<std::vector<idx>>& boundary_loops,
                            const layout_style& style = {}, const layout_overlay& overlay = {})
{
    const face_survey faces = survey_faces(uv, cells, distortion);
    const distortion_scale scale(style.lowest, style.highest);
    const layout_frame frame(impl::with_targets(uv, overlay), style);
    canvas paper(style.width, style.height, style.samples, style.colors.ground);

    impl::draw_faces(paper, frame, uv, cells, distortion, scale);
    // A pen thinner than the samples lie apart would miss some lines entirely.
    const double edge_pen = std::max(0.8 * frame.unit, 1.0 / style.samples);
    if (cells.size() < style.most_edges)
        for (const auto& [a, b] : impl::layout_edges(uv, cells))
            paper.line(frame(uv[static_cast<std::size_t>(a)]), frame(uv[static_cast<std::size_t>(b)]), edge_pen,
                       impl::edge_ink, 0.35);
    impl::draw_boundary(paper, frame, uv, boundary_loops, style.colors.ink);
    impl::draw_flips(paper, frame, uv, cells, faces, style.most_rings);
    impl::draw_overlay(paper, frame, overlay, style.colors);

    const double u = frame.unit;
    draw_text(paper, vec2(36, 48) * u, style.title, {.size = 28 * u, .weight = 0.1, .color = style.colors.ink});
    draw_text(paper, vec2(36, 80) * u, impl::layout_caption(faces, style, overlay),
              {.size = 17 * u, .color = style.colors.soft_ink});
    draw_text(paper, vec2(36, 106) * u, style.note, {.size = 17 * u, .color = style.colors.soft_ink});
    if (!distortion.empty() || !faces.flipped.empty() || !overlay.empty())
        impl::draw_legend(paper, frame, faces, scale, style, overlay);
    return paper.resolve();
}

} // namespace taut::io
