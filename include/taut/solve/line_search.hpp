// SPDX-License-Identifier: MIT
#pragma once

#include <taut/solve/hybrid.hpp>

namespace taut::solve
{

enum class line_search_method
{
    hybrid,       ///< the paper's: full step under strong Wolfe, else bracket and Brent
    strong_wolfe, ///< Nocedal & Wright 3.5, 3.6: a gradient at every trial
    backtracking  ///< Armijo only
};

struct line_search_params
{
    /// hybrid where values are cheaper than gradients; strong_wolfe where they come together anyway.
    line_search_method method = line_search_method::hybrid;

    wolfe_params wolfe = {};
    exact_params exact = {};

    /// No trial step is longer than this part of the step to the barrier (objectives with max_step). Range (0, 1);
    /// 0.9 to 0.99 are sensible: nearer to 1 the energy at the end of the step explodes.
    double barrier_fraction = 0.9;

    /// Trial steps in one pass where the objective has `values`. Range 1..16.
    int batch = 6;

    /// Gradients that strong_wolfe, or values that backtracking may take. Range >= 1.
    int max_evaluations = 30;

    /// Factor between the steps of backtracking. Range (0, 1).
    double shrink = 0.5;

    /// Relative rounding error of a value. A rise by less is no rise, and such small decreases are judged by slopes.
    /// Range [0, 1e-3). An objective that computes in float says so by its own rounding(), and the larger one holds.
    double rounding = 1e-14;

    void validate() const
    {
        wolfe.validate();
        exact.validate();
        if (!(barrier_fraction > 0 && barrier_fraction < 1))
            throw parameter_error("line_search.barrier_fraction", "must be in (0, 1)");
        if (batch < 1 || batch > detail::ladder::most) throw parameter_error("line_search.batch", "must be in 1..16");
        if (max_evaluations < 1) throw parameter_error("line_search.max_evaluations", "must be at least 1");
        if (!(shrink > 0 && shrink < 1)) throw parameter_error("line_search.shrink", "must be in (0, 1)");
        if (!(rounding >= 0 && rounding < 1e-3)) throw parameter_error("line_search.rounding", "must be in [0, 1e-3)");
    }
};

/// The chosen search, from a first trial step. careful: the length of the direction is not to be trusted.
template <line_function Line>
search_result search(Line& phi, double first, const line_search_params& p, bool careful)
{
    switch (p.method)
    {
    case line_search_method::strong_wolfe:
        return strong_wolfe(phi, first, p.wolfe, p.max_evaluations);
    case line_search_method::backtracking:
        return backtracking(phi, first, p.wolfe, p.shrink, p.max_evaluations);
    case line_search_method::hybrid:
        break;
    }
    return hybrid(phi, first, p.wolfe, p.exact, careful);
}

} // namespace taut::solve
