// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/map/map_result.hpp>
#include <utility>

#include <taut/impl/core/budget.hpp>

namespace taut::impl
{

/// The limits of a run of parameterize(), and where its time went: by phases, and stage by stage.
struct run_clock : budget
{
    map_seconds seconds = {};
    stage_log stages = {};

    run_clock(budget::seconds limit, observer ask) : budget(limit, std::move(ask)) { has_result(false); }

    /// Books the time since the last call on a phase.
    void spent(double map_seconds::*phase) { seconds.*phase += lap(); }
};

} // namespace taut::impl
