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

    /// Asked after every iteration: go on? iteration, value (fewest inverted elements so far) and seconds are set.
    taut::observer observer = {};

    /// Names of the stages to run, in this order; empty: all that the dimension and the device allow
    /// (stages.hpp).
    std::vector<std::string> stages = {};

    /// The stages take turns, with so many iterations each in the first round and twice as many in each further one.
    /// Range >= 1.
    int first_round = 150;
    /// After so many rounds without success it gives up, whatever time is left. Range >= 1.
    int rounds = 5;

    /// After success at most so many steps of Newton's method on a barrier energy, to move the map away from the edge
    /// of what is injective; 0 leaves it there. Range >= 0.
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
