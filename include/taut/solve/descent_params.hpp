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

    void validate() const
    {
        line_search.validate();
        stopping.validate();
        if (!(first_length > 0) || !std::isfinite(first_length))
            throw parameter_error("first_length", "must be positive and finite");
    }
};

} // namespace taut::solve
