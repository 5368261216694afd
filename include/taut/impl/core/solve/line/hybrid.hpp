// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include <taut/impl/core/solve/line/backtracking.hpp>
#include <taut/impl/core/solve/line/brent.hpp>
#include <taut/impl/core/solve/line/secant.hpp>
#include <taut/impl/core/solve/line/strong_wolfe.hpp>

namespace taut::solve::impl
{

/// Finds a minimum along the line: bracket, then Brent. The line remembers the lowest trial.
template <line_function Line>
void minimize_line(Line& phi, const line_point& first, const exact_params& p, bool careful)
{
    bracket_triplet t;
    if (first.slope > 0) // below phi(0) but past the minimum: the two slopes bracket it
    {
        const double b = interpolate(phi.start(), first);
        t = {true, false, 0, b, first.step, phi.value(b)};
    }
    else
        t = bracket(phi, first, p.growth, p.bracket_passes);
    if (!t.found || t.capped) return;

    const double relative = careful ? p.first_tolerance : p.tolerance;
    const brent_tolerance tolerance{.relative = relative,
                                    .absolute = relative * 1e-3 * t.c,
                                    .max_evaluations = careful ? p.first_evaluations : p.evaluations};
    brent([&](double a) { return phi.value(a); }, t.a, t.b, t.c, t.value, tolerance);
}

/// The paper's hybrid line search (section 3.2): the full step of a well-scaled direction if it has the strong Wolfe
/// conditions, which costs one value and one gradient and is the common case; else a minimum along the line without
/// derivatives, by a bracket and Brent's method, and the gradient there only.
///
/// careful: the length of the direction means little, as in the first iteration: take its tolerances. Three additions:
/// near convergence, where values are blind, the step is found from slopes (secant); a step at the bound of a barrier
/// is accepted for a sufficient decrease; and backtracking is tried before giving up.
template <line_function Line>
search_result hybrid(Line& phi, double first, const wolfe_params& params, const exact_params& exact, bool careful)
{
    const wolfe_conditions wolfe(phi, params);
    line_point full{.step = std::min(first, phi.bound())};

    if (wolfe.blind(full.step))
    {
        const search_result result = secant(phi, full.step, params, 20);
        if (result.status != search_status::failed || !careful) return result; // a well-scaled step is not too short
    }

    full.value = phi.value_gradient(full.step);
    if (full.value <= phi.ceiling())
    {
        full.slope = phi.slope();
        if (wolfe.accept(full)) return {search_status::accepted, full};
    }

    impl::minimize_line(phi, full, exact, careful);
    const line_point best = phi.best();
    if (!phi.interrupted() && wolfe.armijo(best.step, best.value))
    {
        const search_result result = land(phi, best.step);
        if (result.status != search_status::failed) return result;
    }
    return backtracking(phi, full.step, params, 0.5, 60);
}

} // namespace taut::solve::impl
