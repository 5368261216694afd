// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <utility>

#include <taut/core/stopwatch.hpp>
#include <taut/solve/monitor.hpp>

namespace taut::detail
{

/// The clock of a run of several phases, and what may end it: its time limit and the user's observer.
class run_limits
{
public:
    using seconds = std::chrono::duration<double>;

    run_limits(seconds time_limit, solve::observer observer) : limit_(time_limit), observer_(std::move(observer)) {}

    /// Since the last lap, for the phases of a report.
    double lap() { return watch_.lap(); }
    double total() const { return watch_.total(); }

    bool in_time() const { return total() < limit_.count(); }
    seconds left() const { return std::max(limit_ - seconds(total()), seconds(0)); }

    /// Whether a run that ends from now on has a result. The observer is told at the next question.
    void has_result(bool usable) { usable_ = usable; }

    /// Who has once said no is not asked again, whatever the phase.
    bool ask(solve::progress p)
    {
        p.seconds = total();
        p.usable = usable_;
        stopped_ = stopped_ || (observer_ && !observer_(p));
        return !stopped_;
    }

    /// The clock and the observer, between the steps of a phase: go on?
    bool proceed(const solve::progress& p = {.iterate = false}) { return in_time() && ask(p); }

    /// Whether they have said no.
    bool over() const { return stopped_ || !in_time(); }

    /// Why the run does not go on.
    solve::stop reason() const { return stopped_ ? solve::stop::user : solve::stop::time; }

private:
    stopwatch watch_;
    seconds limit_;
    solve::observer observer_;
    bool stopped_ = false, usable_ = false;
};

} // namespace taut::detail
