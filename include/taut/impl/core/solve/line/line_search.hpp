// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/solve/line/hybrid.hpp>
#include <taut/solve_params.hpp>

namespace taut::solve::impl
{

/// The chosen search, from a first trial step. careful: the length of the direction is not to be trusted.
template <line_function Line>
search_result search(Line& phi, double first, const line_search_params& p, bool careful)
{
    switch (p.method)
    {
    case line_search_method::strong_wolfe:
        return strong_wolfe(phi, first, p.tuning.wolfe, p.tuning.max_evaluations);
    case line_search_method::backtracking:
        return backtracking(phi, first, p.tuning.wolfe, p.tuning.shrink, p.tuning.max_evaluations);
    case line_search_method::hybrid:
        break;
    }
    return hybrid(phi, first, p.tuning.wolfe, p.tuning.exact, careful);
}

} // namespace taut::solve::impl
