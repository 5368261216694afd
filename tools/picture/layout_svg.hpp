// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <picture/layout_parts.hpp>
#include <picture/svg_writer.hpp>

namespace taut::io
{

namespace impl
{

inline void svg_triangle(svg_writer& svg, const std::array<vec2, 3>& t)
{
    svg.move(t[0]);
    svg.line(t[1]);
    svg.line(t[2]);
    svg.close(t[0]);
}

/// One path a colour, on fewer colours than the picture has: 64 steps are too fine to see.
inline void svg_faces(svg_writer& svg, const layout_frame& frame, std::span<const vec2> uv,
                      std::span<const std::array<idx, 3>> cells, std::span<const double> distortion,
                      const distortion_scale& scale)
{
    constexpr std::size_t steps = 64;
    std::array<std::vector<std::size_t>, steps + 1> faces; // the last one: distortion not known
    for (std::size_t f = 0; f < cells.size(); ++f)
    {
        if (!drawable(uv, cells[f]) || flipped(corners(uv, cells[f]))) continue;
        const double t = distortion.empty() ? 0 : scale.position(distortion[f]);
        faces[std::isnan(t) ? steps : static_cast<std::size_t>(std::lround(t * (steps - 1)))].push_back(f);
    }
    for (std::size_t step = 0; step <= steps; ++step)
    {
        if (faces[step].empty()) continue;
        const std::string color = svg_writer::hex(step == steps ? distortion_scale::unknown
                                                                : scale.at(static_cast<double>(step) / (steps - 1)));
        // A thin line of the same colour closes the hairlines that viewers leave between antialiased neighbours.
        svg.begin_path("fill=\"" + color + "\" stroke=\"" + color + "\" stroke-width=\"5\" stroke-linejoin=\"round\"");
        for (std::size_t f : faces[step])
        {
            const auto c = corners(uv, cells[f]);
            const std::array<vec2, 3> t{frame(c[0]), frame(c[1]), frame(c[2])};
            if (!svg_writer::vanishes(t)) svg_triangle(svg, t);
        }
        svg.end_path();
    }
}

inline void svg_boundary(svg_writer& svg, const layout_frame& frame, std::span<const vec2> uv,
                         const std::vector<std::vector<idx>>& loops, rgb ink)
{
    svg.begin_path("fill=\"none\" stroke=\"" + svg_writer::hex(ink) + "\" stroke-width=\"" +
                   svg_writer::pixels(16 * frame.unit) + "\" stroke-linejoin=\"round\" stroke-linecap=\"round\"");
    for (const auto& loop : loops)
        for_each_boundary_edge(uv, loop,
                               [&, end = vec2(-1)](const vec2& a, const vec2& b) mutable
                               {
                                   if (a != end) svg.move(frame(a));
                                   svg.line(frame(b));
                                   end = b;
                               });
    svg.end_path();
}

inline void svg_flips(svg_writer& svg, const layout_frame& frame, std::span<const vec2> uv,
                      std::span<const std::array<idx, 3>> cells, const face_survey& faces, std::size_t most_rings)
{
    if (faces.flipped.empty()) return;
    const std::string color = svg_writer::hex(magenta);
    svg.begin_path("fill=\"" + color + "\" stroke=\"" + color + "\" stroke-width=\"" +
                   svg_writer::pixels(22 * frame.unit) + "\" stroke-linejoin=\"round\" stroke-linecap=\"round\"");
    for (std::size_t f : faces.flipped)
    {
        const auto t = corners(uv, cells[f]);
        svg_triangle(svg, {frame(t[0]), frame(t[1]), frame(t[2])});
    }
    svg.end_path();
    if (faces.flipped.size() > most_rings) return;
    for (std::size_t f : faces.flipped)
        if (const auto centre = ring_centre(frame, corners(uv, cells[f])))
            svg.raw("<circle cx=\"" + svg_writer::pixels(centre->x) + "\" cy=\"" + svg_writer::pixels(centre->y) +
                    "\" r=\"" + svg_writer::pixels(14 * frame.unit) + "\" fill=\"none\" stroke=\"" + color +
                    "\" stroke-width=\"" + svg_writer::pixels(2.4 * frame.unit) + "\"/>\n");
}

inline void svg_edges(svg_writer& svg, const layout_frame& frame, std::span<const vec2> uv,
                      std::span<const std::array<idx, 3>> cells)
{
    svg.begin_path("fill=\"none\" stroke-opacity=\".35\" stroke=\"" + svg_writer::hex(edge_ink) + "\" stroke-width=\"" +
                   svg_writer::pixels(8 * frame.unit) + "\"");
    for (const auto& [a, b] : layout_edges(uv, cells))
    {
        svg.move(frame(uv[static_cast<std::size_t>(a)]));
        svg.line(frame(uv[static_cast<std::size_t>(b)]));
    }
    svg.end_path();
}

inline void svg_mark(svg_writer& svg, const pin_mark& mark, double unit, const palette& colors)
{
    const std::string color = svg_writer::hex(colors.pin);
    const auto circle = [&](const std::string& paint)
    {
        svg.raw("<circle cx=\"" + svg_writer::pixels(mark.at.x) + "\" cy=\"" + svg_writer::pixels(mark.at.y) +
                "\" r=\"" + svg_writer::pixels(mark.radius) + "\" " + paint + "/>\n");
    };
    switch (mark.form)
    {
    case pin_mark::disc:
        circle("fill=\"" + color + "\"");
        break;
    case pin_mark::rail:
        svg.begin_path("fill=\"none\" stroke=\"" + color + "\" stroke-width=\"" + svg_writer::pixels(8 * mark.radius) +
                       "\" stroke-linecap=\"round\"");
        svg.move(mark.low);
        svg.line(mark.high);
        svg.end_path();
        break;
    case pin_mark::ring:
        circle("fill=\"" + svg_writer::hex(colors.ground) + "\" stroke=\"" + color + "\" stroke-width=\"" +
               svg_writer::pixels(1.6 * unit) + "\"");
        break;
    }
}

/// Lines of displacement first, so that none runs over a pin.
inline void svg_overlay(svg_writer& svg, const layout_frame& frame, const layout_overlay& overlay,
                        const palette& colors)
{
    for (const vec2& at : branch_marks(overlay, frame))
        svg.raw("<circle cx=\"" + svg_writer::pixels(at.x) + "\" cy=\"" + svg_writer::pixels(at.y) + "\" r=\"" +
                svg_writer::pixels(9 * frame.unit) + "\" fill=\"" + svg_writer::hex(magenta) +
                "\" fill-opacity=\".4\" stroke=\"" + svg_writer::hex(magenta) + "\" stroke-width=\"" +
                svg_writer::pixels(2.4 * frame.unit) + "\"/>\n");
    const auto marks = pin_marks(overlay, frame, frame.unit);
    if (marks.empty()) return;
    svg.begin_path("fill=\"none\" stroke-opacity=\".7\" stroke=\"" + svg_writer::hex(colors.pin) +
                   "\" stroke-width=\"" + svg_writer::pixels(14 * frame.unit) + "\"");
    for (const auto& mark : marks)
        if (mark.moved)
        {
            svg.move(mark.from);
            svg.line(mark.at);
        }
    svg.end_path();
    for (const auto& mark : marks) svg_mark(svg, mark, frame.unit, colors);
}

inline void svg_legend(svg_writer& svg, const layout_frame& frame, const face_survey& faces,
                       const distortion_scale& scale, const layout_style& style, const layout_overlay& overlay)
{
    constexpr int stops = 16;
    const double u = frame.unit;
    const vec2 low = frame.bar_low, high = frame.bar_high;
    const rgb ink = style.colors.ink;
    svg.words(low - vec2(0, 46 * u), style.scale, 19 * u, ink, true);
    svg.words(low - vec2(0, 23 * u), style.formula, 15 * u, style.colors.soft_ink);

    svg.raw("<defs><linearGradient id=\"scale\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">");
    for (int k = 0; k <= stops; ++k)
        svg.raw("<stop offset=\"" + svg_writer::pixels(k / double(stops)) + "\" stop-color=\"" +
                svg_writer::hex(scale.at(k / double(stops))) + "\"/>");
    svg.raw("</linearGradient></defs>\n");
    svg.rectangle(low - vec2(u), high + vec2(u), ink);
    svg.rectangle(low, high, "url(#scale)");
    for (double tick : scale_ticks(scale))
    {
        const double y = high.y + scale.position(tick) * (low.y - high.y);
        svg.rectangle({high.x + u, y - 0.7 * u}, {high.x + 7 * u, y + 0.7 * u}, ink);
        svg.words({high.x + 14 * u, y + 6 * u}, tick_label(scale, tick), 17 * u, ink);
    }
    double y = high.y + 40 * u;
    for (const auto& [color, text] : legend_entries(faces, overlay))
    {
        svg.rectangle(vec2(low.x, y - 15 * u), vec2(high.x, y + 3 * u), color);
        svg.words({high.x + 14 * u, y}, text, 17 * u, ink);
        y += 28 * u;
    }
    for (const auto& [hard, text] : pin_legend(overlay))
    {
        const vec2 at((low.x + high.x) / 2, y - 6 * u);
        svg_mark(svg, {hard ? pin_mark::disc : pin_mark::ring, at, at, at, at, false, 6 * u}, u, style.colors);
        svg.words({high.x + 14 * u, y}, text, 17 * u, ink);
        y += 28 * u;
    }
}

} // namespace impl

/// The picture of layout_picture as the text of an SVG 1.1 document: triangles merged into one path a colour (64 steps
/// of the scale), coordinates in tenths of a pixel, captions as text. 15 to 25 bytes a face; faces too small to cover a
/// tenth of a pixel are left out unless they are flipped.
/// Arguments and errors as there; style.samples has no meaning here.
inline std::string layout_svg(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells,
                              std::span<const double> distortion, const std::vector<std::vector<idx>>& boundary_loops,
                              const layout_style& style = {}, const layout_overlay& overlay = {})
{
    if (style.width < 1) throw parameter_error("width", "must be positive");
    if (style.height < 1) throw parameter_error("height", "must be positive");
    const face_survey faces = survey_faces(uv, cells, distortion);
    const distortion_scale scale(style.lowest, style.highest);
    const layout_frame frame(impl::with_targets(uv, overlay), style);
    impl::svg_writer svg(style.width, style.height, style.colors.ground);

    impl::svg_faces(svg, frame, uv, cells, distortion, scale);
    if (cells.size() < style.most_edges) impl::svg_edges(svg, frame, uv, cells);
    impl::svg_boundary(svg, frame, uv, boundary_loops, style.colors.ink);
    impl::svg_flips(svg, frame, uv, cells, faces, style.most_rings);
    impl::svg_overlay(svg, frame, overlay, style.colors);

    const double u = frame.unit;
    svg.words(vec2(36, 48) * u, style.title, 28 * u, style.colors.ink, true);
    svg.words(vec2(36, 80) * u, impl::layout_caption(faces, style, overlay), 17 * u, style.colors.soft_ink);
    svg.words(vec2(36, 106) * u, style.note, 17 * u, style.colors.soft_ink);
    if (!distortion.empty() || !faces.flipped.empty() || !overlay.empty())
        impl::svg_legend(svg, frame, faces, scale, style, overlay);
    return svg.finish();
}

} // namespace taut::io
