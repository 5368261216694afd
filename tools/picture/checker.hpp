// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include <picture/color.hpp>
#include <picture/faces.hpp>

namespace taut::io
{

/// A checkerboard over the plane of a map: two greys that lean to one colour at each end of u and of v, so that turned
/// and mirrored patches are told apart. Squares on the surface show where a map is conformal, equal ones where it keeps
/// areas.
class checkerboard
{
public:
    /// A square of the area of the map would be `checks` squares wide: they have a sensible size on the surface also
    /// where the map is a long strip or a star.
    checkerboard(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells, double checks)
    {
        vec2 low(std::numeric_limits<double>::infinity()), high(-low);
        double area = 0;
        for (const auto& cell : cells)
            if (impl::drawable(uv, cell))
            {
                const auto t = impl::corners(uv, cell);
                area += std::abs(uv_determinant(t[0], t[1], t[2])) / 2;
                for (const vec2& p : t)
                {
                    low = glm::min(low, p);
                    high = glm::max(high, p);
                }
            }
        const double side = std::max(high.x - low.x, high.y - low.y), period = std::sqrt(area) / checks;
        if (!(period > 0 && std::isfinite(side / period))) return; // no area: everything is one square
        low_ = low;
        extent_ = glm::max(high - low, vec2(side * 1e-9));
        period_ = period;
    }

    /// Side of a square, in units of uv.
    double period() const noexcept { return period_; }

    /// Returns whether a point is in a dark square.
    bool dark(const vec2& uv) const
    {
        const vec2 cell = glm::floor((uv - low_) / period_);
        return std::fmod(std::abs(cell.x + cell.y), 2) == 1;
    }

    /// Linear light, before shading.
    vec3 operator()(const vec2& uv) const
    {
        const vec2 t = glm::clamp((uv - low_) / extent_, vec2(0), vec2(1)) * 2.0 - 1.0;
        // u from green to red, v from blue to yellow: the axes of OKLab. Dark squares carry more colour.
        return dark(uv) ? oklab_to_linear({0.56, 0.055 * t.x, 0.065 * t.y})
                        : oklab_to_linear({0.93, 0.018 * t.x, 0.022 * t.y});
    }

private:
    vec2 low_{0};
    vec2 extent_{1};
    double period_ = 1;
};

} // namespace taut::io
