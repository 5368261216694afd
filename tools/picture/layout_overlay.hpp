// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <picture/color.hpp>
#include <picture/faces.hpp>

namespace taut::io
{

/// A constraint on one vertex of a layout, in uv.
struct layout_pin
{
    vec2 from;             ///< where the vertex starts or is; a line leads from here to the target
    vec2 target;           ///< where it has to be, or should rather be; a coordinate that is free, as it is
    bool hard = true;      ///< a pin (filled), or a spring (hollow)
    std::uint8_t held = 3; ///< of a pin: 1: u alone, 2: v alone; drawn as a rail along the other axis
};

/// Overlay of a layout.
struct layout_overlay
{
    std::vector<layout_pin> pins = {};
    std::vector<vec2> branch_points = {}; ///< places in uv that the map winds around more than once: magenta targets

    bool empty() const { return pins.empty() && branch_points.empty(); }
};

namespace impl
{

/// Style of a pin, in pixels.
struct pin_mark
{
    enum shape
    {
        disc, ///< held altogether
        rail, ///< one coordinate held: a bar from low to high
        ring  ///< a spring
    };
    shape form;
    vec2 at;            ///< the target
    vec2 low, high;     ///< of a rail
    vec2 from;          ///< start of the line of displacement
    bool moved = false; ///< that line is long enough to be seen
    double radius = 0;
};

/// Works out the marks of an overlay; what is not finite is left out. place: uv -> pixels.
template <class Place>
std::vector<pin_mark> pin_marks(const layout_overlay& overlay, const Place& place, double unit)
{
    // Many pins are small, so that the map shows between them.
    const std::size_t n = overlay.pins.size();
    const double radius = (n <= 100 ? 6.0 : n <= 1000 ? 4.0 : 2.5) * unit;
    std::vector<pin_mark> marks;
    for (const layout_pin& p : overlay.pins)
    {
        if (!drawable(p.from) || !drawable(p.target)) continue;
        pin_mark mark{};
        mark.form = !p.hard ? pin_mark::ring : p.held == 1 || p.held == 2 ? pin_mark::rail : pin_mark::disc;
        mark.at = place(p.target);
        mark.from = place(p.from);
        mark.radius = radius;
        const vec2 along = (p.held == 1 ? vec2(0, 2.5) : vec2(2.5, 0)) * radius;
        mark.low = mark.at - along;
        mark.high = mark.at + along;
        mark.moved = glm::distance(mark.from, mark.at) > 1.5 * unit;
        marks.push_back(mark);
    }
    return marks;
}

/// Entries of the legend: pins, springs.
inline std::vector<std::pair<bool, std::string>> pin_legend(const layout_overlay& overlay)
{
    bool hard = false, soft = false;
    for (const auto& p : overlay.pins) (p.hard ? hard : soft) = true;
    std::vector<std::pair<bool, std::string>> entries;
    if (hard) entries.emplace_back(true, "pin");
    if (soft) entries.emplace_back(false, "spring");
    return entries;
}

/// Centres of the targets at branch points, in pixels.
template <class Place>
std::vector<vec2> branch_marks(const layout_overlay& overlay, const Place& place)
{
    std::vector<vec2> marks;
    for (const vec2& p : overlay.branch_points)
        if (drawable(p)) marks.push_back(place(p));
    return marks;
}

/// The points that have to lie within the plot.
inline std::vector<vec2> with_targets(std::span<const vec2> uv, const layout_overlay& overlay)
{
    std::vector<vec2> points(uv.begin(), uv.end());
    for (const auto& p : overlay.pins)
    {
        points.push_back(p.target);
        points.push_back(p.from);
    }
    return points;
}

} // namespace impl

} // namespace taut::io
