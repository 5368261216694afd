// SPDX-License-Identifier: MIT
#pragma once

#include <taut/charts.hpp>
#include <taut/options.hpp>
#include <taut/queue.hpp>
#include <taut/solve_params.hpp>

namespace taut::impl
{

/// Solver of maps of a rough surface, which ends where two steps gain less than a hundredth each of what the map has
/// above an isometry. One alone may be short, the first one above all.
inline solve::params rough_solve(int max_iterations)
{
    return {
        .decrease_tolerance = 1e-2, .max_iterations = max_iterations, .tuning = {.stopping = {.decrease_count = 2}}};
}

/// Precision of maps of a rough surface: its needles are more than single precision holds.
inline precision rough_precision(const queue& q)
{
    return q.device().has_fp64() ? precision::fp64 : precision::automatic;
}

} // namespace taut::impl
