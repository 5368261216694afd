// SPDX-License-Identifier: MIT
#pragma once

#include <taut/errors.hpp>

namespace taut::impl
{

/// Numbers of untangling that no user has a reason to set.
struct untangle_tuning
{
    /// Iterations of each stage in the first round; stages alternate, with twice as many in each further round. Range
    /// >= 1.
    int first_round = 150;

    /// Maximum number of Newton steps on a barrier energy after success, to move the map away from the boundary of the
    /// feasible set; 0: none. Range >= 0.
    int margin_steps = 20;

    void validate() const
    {
        if (first_round < 1) throw parameter_error("first_round", "must be at least 1");
        if (margin_steps < 0) throw parameter_error("margin_steps", "must not be negative");
    }
};

} // namespace taut::impl
