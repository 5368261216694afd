// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/solve/line/wolfe_conditions.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace taut::solve::impl
{

/// A step with the approximate Wolfe conditions by secant steps on phi', for the last iterations of a run, where
/// values of phi differ by rounding only.
///
/// Source: the secant step of Hager & Zhang 2005, section 4, with a bisection in place of their double secant.
template <line_function Line>
search_result secant(Line& phi, double first, const wolfe_params& params, int evaluations)
{
    const wolfe_conditions wolfe(phi, params);
    line_point low = phi.start();                                     // phi' < 0
    line_point high{.step = std::numeric_limits<double>::infinity()}; // phi' > 0, or too high

    line_point at{.step = std::min(first, phi.bound())};
    for (; evaluations > 0; --evaluations)
    {
        at = {.step = at.step, .value = phi.value_gradient(at.step)};
        if (phi.interrupted()) return {search_status::interrupted, at};
        if (at.value <= phi.ceiling())
        {
            at.slope = phi.slope();
            if (wolfe.accept(at)) return {search_status::accepted, at};
        }
        const line_point before = low;
        (at.slope < 0 ? low : high) = at; // a NaN, not asked for, is too high

        // The root of the line through two slopes; kept in the bracket, and within a factor of 4 without one.
        const line_point& other = at.slope < 0 && std::isinf(high.step) ? before : (at.slope < 0 ? high : low);
        double next = at.step - at.slope * (at.step - other.step) / (at.slope - other.slope);
        if (std::isfinite(high.step))
        {
            const double margin = 0.05 * (high.step - low.step);
            if (!(next > low.step + margin && next < high.step - margin)) next = (low.step + high.step) / 2;
        }
        else
            next = next > low.step ? std::min(next, 4 * low.step) : 4 * low.step;
        if (low.step >= phi.bound()) break;
        at.step = std::min(next, phi.bound());
    }
    if (low.step > 0 && low.value <= phi.ceiling()) return land(phi, low.step);
    return {search_status::failed, at};
}

} // namespace taut::solve::impl
