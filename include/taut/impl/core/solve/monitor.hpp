// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/core/budget.hpp>
#include <taut/solve_params.hpp>

#include <optional>
#include <utility>

namespace taut::solve::impl
{

/// Reason for the end of a run whose budget is over.
inline stop stop_of(const taut::impl::budget& limits)
{
    return limits.refused() ? stop::user : stop::time;
}

/// The budget of a minimisation and its counters. Everything that launches work on a device reports here right after
/// it, so that a run can be cancelled within an iteration.
class monitor
{
public:
    explicit monitor(const run_limits& limits) : budget_(limits.time_limit, limits.observer) {}

    double seconds() const { return budget_.total(); }
    int evaluations() const noexcept { return now_.evaluations; }
    int gradients() const noexcept { return gradients_; }

    void count(int values, int gradients) noexcept
    {
        now_.evaluations += values;
        gradients_ += gradients;
    }

    /// The state that later questions carry: a new iterate was accepted.
    void iterate(int iteration, double value, double gradient, double step)
    {
        now_.iteration = iteration;
        now_.value = value;
        now_.gradient = gradient;
        now_.step = step;
        now_.iterate = true;
        budget_.proceed(now_);
    }

    /// Asks in the middle of a line search; whether to go on.
    bool proceed()
    {
        now_.iterate = false;
        return budget_.proceed(now_);
    }

    /// stop::time or stop::user once a limit has ended the run.
    std::optional<stop> reason() const
    {
        if (!budget_.over()) return std::nullopt;
        return stop_of(budget_);
    }

private:
    taut::impl::budget budget_;
    progress now_;
    int gradients_ = 0;
};

} // namespace taut::solve::impl
