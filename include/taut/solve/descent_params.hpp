// SPDX-License-Identifier: MIT
#pragma once

#include <taut/solve/line_search.hpp>
#include <taut/solve/stopping.hpp>

#include <cmath>

namespace taut::solve
{

/// What all methods share.
struct descent_params
{
    solve::line_search_params line_search = {};
    stopping_params stopping = {};

    /// Length of the first direction, a guess of the distance to go; a wrong one costs trial steps in the first
    /// iteration only. Range > 0. Unused with a preconditioner, whose scale is trusted.
    double first_length = 1;

    /// An objective with a Hessian makes its preconditioner anew, and the method forgets its pairs, once the value has
    /// fallen by more than this part since the last time. Range > 0.
    double linearize_after = 0.03;

    void validate() const
    {
        line_search.validate();
        stopping.validate();
        if (!(first_length > 0) || !std::isfinite(first_length))
            throw parameter_error("first_length", "must be positive and finite");
        if (!(linearize_after > 0)) throw parameter_error("linearize_after", "must be positive");
    }
};

} // namespace taut::solve
