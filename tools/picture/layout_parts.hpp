// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <picture/colormap.hpp>
#include <picture/format.hpp>
#include <picture/layout_frame.hpp>
#include <picture/layout_overlay.hpp>

/// Parts of a UV layout, computed once for the pixels and the SVG.
namespace taut::io::impl
{

/// Of the edges of triangles: dark on every ground, as the faces below them are light.
inline constexpr rgb edge_ink{40, 30, 20};

/// Calls edge(a, b) with the uv points of each drawable edge of a closed vertex loop, in order.
template <class Edge>
void for_each_boundary_edge(std::span<const vec2> uv, const std::vector<idx>& loop, Edge&& edge)
{
    const auto known = [&](idx v)
    { return v >= 0 && static_cast<std::size_t>(v) < uv.size() && drawable(uv[static_cast<std::size_t>(v)]); };
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
        const idx a = loop[i], b = loop[i + 1 < loop.size() ? i + 1 : 0];
        if (known(a) && known(b)) edge(uv[static_cast<std::size_t>(a)], uv[static_cast<std::size_t>(b)]);
    }
}

/// Centre of the ring around a flipped face, in pixels; none around a face large enough to be seen.
inline std::optional<vec2> ring_centre(const layout_frame& frame, const std::array<vec2, 3>& t)
{
    const std::array<vec2, 3> p{frame(t[0]), frame(t[1]), frame(t[2])};
    const vec2 middle = (p[0] + p[1] + p[2]) / 3.0;
    double reach = 0;
    for (const vec2& q : p) reach = std::max(reach, glm::length(q - middle));
    return reach < 10 * frame.unit ? std::optional(middle) : std::nullopt;
}

/// Ticks of a logarithmic scale: its ends, and of 1, 1.5, 2, 3, 5, 7 times powers of ten those that are neither outside
/// nor close to a neighbour.
inline std::vector<double> scale_ticks(const distortion_scale& scale)
{
    std::vector<double> ticks{scale.lowest()};
    const int first = static_cast<int>(std::floor(std::log10(scale.lowest())));
    const int last = static_cast<int>(std::ceil(std::log10(scale.highest())));
    for (int e = first; e <= last; ++e)
        for (double m : {1.0, 1.5, 2.0, 3.0, 5.0, 7.0})
        {
            const double tick = m * std::pow(10.0, e);
            if (scale.position(tick) - scale.position(ticks.back()) > 0.06 && scale.position(tick) < 0.94)
                ticks.push_back(tick);
        }
    ticks.push_back(scale.highest());
    return ticks;
}

/// The words at a tick; beyond the upper end of the scale the colour stays the same.
inline std::string tick_label(const distortion_scale& scale, double tick)
{
    return format_number(tick, 3) + (tick >= scale.highest() ? "+" : "");
}

/// Swatches below the legend's bar, only of colours that the picture contains.
inline std::vector<std::pair<rgb, std::string>> legend_entries(const face_survey& faces, const layout_overlay& overlay)
{
    std::vector<std::pair<rgb, std::string>> entries;
    if (!faces.flipped.empty()) entries.emplace_back(magenta, "flipped");
    if (!overlay.branch_points.empty()) entries.emplace_back(magenta, "winds twice");
    if (faces.unknown > 0) entries.emplace_back(distortion_scale::unknown, "unknown");
    return entries;
}

/// The second line of a layout: "22,704 faces, 3 flipped, energy 4.12; distortion median ...".
inline std::string layout_caption(const face_survey& faces, const layout_style& style, const layout_overlay& overlay)
{
    std::string text = style.census;
    if (text.empty())
        text = format_count(faces.faces) + (faces.faces == 1 ? " face, " : " faces, ") +
               format_count(faces.flipped.size()) + " flipped";
    if (const std::size_t n = overlay.branch_points.size(); n > 0)
        text += ", " + format_count(n) + (n == 1 ? " branch point" : " branch points");
    if (style.energy) text += ", energy " + format_number(*style.energy);
    if (faces.undrawable > 0) text += ", " + format_count(faces.undrawable) + " not finite";
    if (faces.measured)
        text += "  |  " + style.scale + ": median " + format_number(faces.median, 3) + ", 99 % below " +
                format_number(faces.percentile99, 3) + ", largest " + format_number(faces.most, 3);
    return text;
}

/// Unique edges of the drawable faces, by vertex numbers.
inline std::vector<std::array<idx, 2>> layout_edges(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells)
{
    std::vector<std::array<idx, 2>> edges;
    for (const auto& cell : cells)
        if (drawable(uv, cell))
            for (std::size_t i = 0; i < 3; ++i)
                edges.push_back({std::min(cell[i], cell[(i + 1) % 3]), std::max(cell[i], cell[(i + 1) % 3])});
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

} // namespace taut::io::impl
