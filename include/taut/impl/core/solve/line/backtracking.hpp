// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>

#include <taut/impl/core/solve/line/bracket.hpp>
#include <taut/impl/core/solve/line/wolfe_conditions.hpp>

namespace taut::solve::impl
{

/// The longest step of the ladder first, r first, r^2 first, ... that has the Armijo condition (3.7a); the gradient is
/// computed there only. The search of last resort: it needs nothing but a direction of descent.
///
/// Source: Nocedal & Wright, Algorithm 3.1. Lines with batches try several steps of the ladder in one pass.
template <line_function Line>
search_result backtracking(Line& phi, double first, const wolfe_params& params, double shrink, int evaluations)
{
    const wolfe_conditions wolfe(phi, params);
    line_point at{.step = std::min(first, phi.bound())};
    at.value = phi.value(at.step);
    if (wolfe.armijo(at.step, at.value)) return land(phi, at.step);

    for (int used = 1; used < evaluations && !phi.interrupted() && !lost_in_rounding(phi, at.step);)
    {
        const impl::ladder trial(phi, at.step, shrink);
        if (trial.size() == 0) break;
        for (std::size_t i = 0; i < trial.size(); ++i)
        {
            at = trial[i];
            if (wolfe.armijo(at.step, at.value)) return land(phi, at.step);
        }
        used += int(trial.size());
    }
    return {phi.interrupted() ? search_status::interrupted : search_status::failed, at};
}

} // namespace taut::solve::impl
