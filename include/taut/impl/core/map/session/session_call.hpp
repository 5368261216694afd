// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include <taut/impl/core/map/run_clock.hpp>
#include <taut/session.hpp>

namespace taut::impl
{

/// One call of session::solve(): its limits, and its report.
struct session_call
{
    session_report& report;
    run_clock clock;
    int steps_left;
    double step_seconds;  ///< of the last step, also of an earlier call
    std::size_t vertices; ///< of the mesh

    /// Returns whether another step may be made.
    bool may_step() { return steps_left > 0 && clock.left().count() > step_seconds && clock.proceed(); }

    /// Returns whether the budget would last for so many steps.
    bool lasts(int steps) const { return steps_left >= steps && clock.left().count() >= steps * step_seconds; }

    void count(int steps)
    {
        report.steps += steps;
        steps_left -= std::min(steps, steps_left);
    }

    /// Attributes the time since the end of the last stage to this one.
    void book(double session_seconds::*phase, stage_report did)
    {
        report.seconds.*phase += clock.lap();
        if (did.vertices == 0) did.vertices = vertices;
        clock.stages.add(std::move(did));
    }

    /// Limits of an untangling within this call.
    run_limits left()
    {
        return {clock.left(), [this](const progress&) { return clock.ask({.iterate = false}); }};
    }
};

} // namespace taut::impl
