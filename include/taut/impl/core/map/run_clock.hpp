// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/objective/stage_report.hpp>
#include <taut/parameterize.hpp>
#include <utility>

#include <taut/impl/core/core/budget.hpp>

namespace taut::impl
{

/// Limits of a run of parameterize(), and its times by phases and stages.
struct run_clock : budget
{
    map_seconds seconds = {};
    stage_log stages = {};

    run_clock(budget::seconds limit, observer ask) : budget(limit, std::move(ask)) { has_result(false); }

    /// Adds the time since the last call to a phase.
    void spent(double map_seconds::*phase) { seconds.*phase += lap(); }
};

} // namespace taut::impl
