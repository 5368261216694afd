// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <taut/impl/core/error.hpp>
#include <taut/impl/untangle/tuning.hpp>

namespace taut
{

/// Parameters of untangle(). Every field has a sensible default.
struct untangle_params
{
    /// Names of the stages to run, in this order; empty: all that the dimension and the device allow
    /// (stages.hpp).
    std::vector<std::string> stages = {};

    /// Maximum number of rounds, after which it gives up, whatever time is left. Range >= 1.
    int rounds = 5;

    /// Not for users: what tests and measurements set.
    impl::untangle_tuning tuning = {};

    /// Throws parameter_error that names the field; the names of stages are looked up by untangle().
    void validate() const
    {
        if (rounds < 1) throw parameter_error("rounds", "must be at least 1");
        tuning.validate();
    }
};

} // namespace taut
