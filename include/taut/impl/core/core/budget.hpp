// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include <taut/options.hpp>

namespace taut::impl
{

/// Clock and limits of a run: a time limit and an observer. Once one has ended the run, none is asked again.
class budget
{
public:
    using clock = std::chrono::steady_clock;
    using seconds = std::chrono::duration<double>;

    static constexpr seconds unlimited{std::numeric_limits<double>::infinity()};

    explicit budget(seconds limit = unlimited, observer ask = {}) : limit_(limit), observer_(std::move(ask)) {}

    double total() const { return seconds(clock::now() - start_).count(); }

    /// Seconds since the last lap, for the phases of a report.
    double lap()
    {
        const auto now = clock::now();
        return seconds(now - std::exchange(lap_, now)).count();
    }

    bool in_time() const { return total() < limit_.count(); }
    seconds left() const { return std::max(limit_ - seconds(total()), seconds(0)); }

    /// Sets whether a run that ends from now on has a result, as it mostly has. The observer is told at its next call.
    void has_result(bool usable) { usable_ = usable; }

    /// Asks the observer alone, where others keep the time. Returns false to end the run.
    bool ask(progress p)
    {
        p.seconds = total();
        p.usable = usable_;
        refused_ = refused_ || (observer_ && !observer_(p));
        return !refused_;
    }

    /// Asks the clock, then the observer. Returns false to end the run. Without an argument: inside of a step, without
    /// a new iterate.
    bool proceed(const progress& p = {.iterate = false})
    {
        late_ = late_ || !in_time();
        return !late_ && ask(p);
    }

    /// Returns whether a limit is reached or the observer has refused so far.
    bool over() const { return late_ || refused_; }
    bool refused() const { return refused_; } ///< by the observer

private:
    seconds limit_;
    observer observer_;
    clock::time_point start_ = clock::now(), lap_ = start_;
    bool late_ = false, refused_ = false, usable_ = true;
};

} // namespace taut::impl
