// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <limits>
#include <string>
#include <vector>

#include <taut/impl/core/error.hpp>
#include <taut/impl/core/observer.hpp>

namespace taut
{

/// Parameters of untangle(). Every field has a sensible default.
struct untangle_params
{
    /// Wall-clock limit of the whole call. When it is reached, the best map so far is returned. Range >= 0.
    std::chrono::duration<double> time_limit{std::numeric_limits<double>::infinity()};

    /// Callback after every iteration; returning false ends the run. iteration, value (fewest inverted elements so far)
    /// and seconds are set.
    taut::observer observer = {};

    /// Names of the stages to run, in this order; empty: all that the dimension and the device allow
    /// (stages.hpp).
    std::vector<std::string> stages = {};

    /// Iterations of each stage in the first round; stages alternate, with twice as many in each further round. Range
    /// >= 1.
    int first_round = 150;
    /// Maximum number of rounds, after which it gives up, whatever time is left. Range >= 1.
    int rounds = 5;

    /// Maximum number of Newton steps on a barrier energy after success, to move the map away from the boundary of the
    /// feasible set; 0: none. Range >= 0.
    int margin_steps = 20;

    /// Throws parameter_error that names the field; the names of stages are looked up by untangle().
    void validate() const
    {
        if (!(time_limit.count() >= 0)) throw parameter_error("time_limit", "must not be negative");
        if (first_round < 1) throw parameter_error("first_round", "must be at least 1");
        if (rounds < 1) throw parameter_error("rounds", "must be at least 1");
        if (margin_steps < 0) throw parameter_error("margin_steps", "must not be negative");
    }
};

} // namespace taut
