// SPDX-License-Identifier: MIT
#pragma once

#include <taut/map/map_result.hpp>
#include <taut/solve/run_limits.hpp>

namespace taut::detail
{

/// The limits of a run of parameterize(), and where its time went.
struct run_clock : run_limits
{
    using run_limits::run_limits;

    map_seconds seconds = {};

    /// Books the time since the last call on a phase.
    void spent(double map_seconds::*phase) { seconds.*phase += lap(); }
};

} // namespace taut::detail
