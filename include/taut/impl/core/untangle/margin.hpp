// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include <taut/impl/core/untangle/state.hpp>

namespace taut::impl
{

/// Moves the injective map of the state away from the boundary of the feasible set, so that a barrier energy can start
/// from it: at most `steps` of Newton's method on |S|^2 / det S + det S + 1 / det S, which keep all determinants
/// positive, until one gains less than 1 %.
inline void improve_margin(untangle_state<triangle>& state, int steps)
{
    if (steps == 0) return;
    const auto& problem = state.problem();
    auto x = state.best();
    const auto newton = state.make_newton(
        {.rest = problem.rest, .held = problem.held, .shapes = shapes_wanted(problem, expected_measure(problem, x))});
    newton->proceed = [&state] { return state.proceed(0); };
    double value = newton->value(x);
    for (int i = 0; i < steps && value < std::numeric_limits<double>::infinity(); ++i)
    {
        const double before = value;
        value = newton->step(x, before);
        state.stepped(before, value, newton->last_length());
        if (!(value < before) || !state.replace(x) || !state.proceed() || value > 0.99 * before) break;
    }
}

} // namespace taut::impl
