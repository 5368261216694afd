// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/error.hpp>

namespace taut::impl
{

/// Numbers of untangling that no user has a reason to set.
struct untangle_tuning
{
    /// The stages take turns, with so many iterations each in the first round and twice as many in each further one.
    /// Range >= 1.
    int first_round = 150;

    /// After success at most so many steps of Newton's method on a barrier energy, to move the map away from the edge
    /// of what is injective; 0 leaves it there. Range >= 0.
    int margin_steps = 20;

    void validate() const
    {
        if (first_round < 1) throw parameter_error("first_round", "must be at least 1");
        if (margin_steps < 0) throw parameter_error("margin_steps", "must not be negative");
    }
};

} // namespace taut::impl
