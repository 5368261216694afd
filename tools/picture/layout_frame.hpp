// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <picture/faces.hpp>
#include <picture/layout_style.hpp>

namespace taut::io
{

/// Frame of a UV layout, shared by the pixels and the SVG, with the positions of uv points for overlays (a pin, a
/// target, a displacement).
///
///     +-----------------------------------------+
///     | title                                   |
///     | caption                                 |
///     |  +-----------------------------+  scale |
///     |  |                             |   [#]  |
///     |  |            plot             |   [#]  |
///     |  |                             |   [#]  |
///     |  +-----------------------------+        |
///     +-----------------------------------------+
///
/// All lengths are in pixels, y down. Everything scales with the picture; `unit` is 1 at 1200 x 900.
class layout_frame
{
public:
    layout_frame(std::span<const vec2> uv, const layout_style& style)
        : unit(std::min(style.width / 1200.0, style.height / 900.0))
    {
        const double lines = style.note.empty() ? 2 : 3;
        plot_low = vec2(36, 76 + 26 * (lines - 1)) * unit;
        plot_high = vec2(style.width, style.height) - vec2(186, 36) * unit;
        bar_low = vec2(style.width - 146 * unit, plot_low.y + 70 * unit);
        bar_high = bar_low + vec2(26 * unit, std::max(0.0, std::min(plot_high.y - bar_low.y - 70 * unit, 440 * unit)));

        vec2 low(std::numeric_limits<double>::infinity()), high(-low);
        for (const vec2& p : uv)
            if (impl::drawable(p))
            {
                low = glm::min(low, p);
                high = glm::max(high, p);
            }
        if (!(low.x <= high.x)) low = high = vec2(0); // nothing to draw
        const vec2 extent = high - low, room = plot_high - plot_low;
        const double fit = std::min(room.x / extent.x, room.y / extent.y);
        scale = std::isfinite(fit) && fit > 0 ? fit : 1; // one point, or none
        centre = low + extent / 2.0;
    }

    /// uv -> pixels. The v axis points up in the picture.
    vec2 operator()(const vec2& uv) const
    {
        return (plot_low + plot_high) / 2.0 + scale * vec2(uv.x - centre.x, centre.y - uv.y);
    }

    double unit;              ///< pixels a design pixel
    double scale = 1;         ///< pixels a unit of uv
    vec2 centre{0};           ///< uv of the middle of the plot
    vec2 plot_low, plot_high; ///< corners of the plot
    vec2 bar_low, bar_high;   ///< corners of the legend's bar: highest distortion at the top
};

} // namespace taut::io
