// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/solve/line/wolfe_conditions.hpp>

#include <algorithm>
#include <cmath>

namespace taut::solve::impl
{

/// Minimiser of the cubic through two points with slopes, or of the parabola where only `a` has one; kept away from
/// the ends of the interval so that it shrinks (Nocedal & Wright, (3.59) and the text below it).
inline double interpolate(const line_point& a, const line_point& b)
{
    const double width = b.step - a.step;
    double t = a.step + width / 2;
    if (std::isfinite(a.value) && std::isfinite(b.value))
    {
        if (std::isfinite(b.slope))
        {
            const double d1 = a.slope + b.slope - 3 * (a.value - b.value) / (a.step - b.step);
            const double d2 = std::copysign(std::sqrt(std::max(d1 * d1 - a.slope * b.slope, 0.0)), width);
            t = b.step - width * (b.slope + d2 - d1) / (b.slope - a.slope + 2 * d2);
        }
        else
            t = a.step - a.slope * width * width / (2 * (b.value - a.value - a.slope * width));
    }
    const double low = a.step + 0.1 * width, high = a.step + 0.9 * width;
    if (!std::isfinite(t)) return a.step + width / 2;
    return std::clamp(t, std::min(low, high), std::max(low, high));
}

/// A step with the strong Wolfe conditions, by bracketing and zooming with gradients.
///
/// Source: Nocedal & Wright, Algorithms 3.5 (line search) and 3.6 (zoom). Where `evaluations` run out, or at the bound
/// of a barrier, a step with the first condition alone is accepted.
///
/// | here         | there          |
/// |--------------|----------------|
/// | `before, at` | a_{i-1}, a_i   |
/// | `low, high`  | a_lo, a_hi     |
template <line_function Line>
search_result strong_wolfe(Line& phi, double first, const wolfe_params& params, int evaluations)
{
    constexpr double growth = 2.5; // a_i -> a_{i+1}; between doubling and the cubic extrapolation's usual cap
    const wolfe_conditions wolfe(phi, params);
    line_point low = phi.start(), high;
    bool bracketed = false;

    line_point at{.step = std::min(first, phi.bound())};
    for (; evaluations > 0; --evaluations)
    {
        at = {.step = at.step, .value = phi.value_gradient(at.step)};
        if (phi.interrupted()) return {search_status::interrupted, at};

        const bool too_high = !wolfe.armijo(at.step, at.value) || (low.step > 0 && at.value >= low.value);
        if (!too_high || at.value <= phi.ceiling())
        {
            at.slope = phi.slope();
            if (wolfe.accept(at)) return {search_status::accepted, at};
        }
        if (too_high)
        {
            high = at;
            bracketed = true;
        }
        else
        {
            // In the zoom, the half of [low, high] that the slope at `at` points into; before it, the first rise.
            const double toward_high = bracketed ? high.step - low.step : 1;
            if (at.slope * toward_high >= 0)
            {
                high = low;
                bracketed = true;
            }
            low = at;
        }
        if (!bracketed && at.step >= phi.bound()) break;
        at.step = bracketed ? interpolate(low, high) : std::min(growth * at.step, phi.bound());
        if (at.step == low.step || at.step == high.step) break; // no number left between the two
    }
    if (low.step > 0) return land(phi, low.step);
    return {search_status::failed, low};
}

} // namespace taut::solve::impl
