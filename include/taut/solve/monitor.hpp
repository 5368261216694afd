// SPDX-License-Identifier: MIT
#pragma once

#include <taut/solve/observer.hpp>
#include <taut/solve/stop.hpp>

#include <chrono>
#include <limits>
#include <optional>
#include <utility>

namespace taut::solve
{

/// The clock, the counters and the observer of one run. Everything that launches work on a device reports here right
/// after it, so that a run can be cancelled within an iteration.
class monitor
{
public:
    using clock = std::chrono::steady_clock;

    explicit monitor(observer ask, std::chrono::duration<double> limit = unlimited())
        : ask_(std::move(ask)), limit_(limit.count())
    {
    }

    static constexpr std::chrono::duration<double> unlimited()
    {
        return std::chrono::duration<double>(std::numeric_limits<double>::infinity());
    }

    double seconds() const { return std::chrono::duration<double>(clock::now() - start_).count(); }
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
        ask(true);
    }

    /// Asks the clock and the observer in the middle of a line search; whether to go on.
    bool proceed()
    {
        ask(false);
        return !reason_;
    }

    /// stop::time or stop::user once either has spoken.
    std::optional<stop> reason() const noexcept { return reason_; }

private:
    void ask(bool iterate)
    {
        if (reason_) return;
        now_.seconds = seconds();
        now_.iterate = iterate;
        if (now_.seconds > limit_)
            reason_ = stop::time;
        else if (ask_ && !ask_(now_))
            reason_ = stop::user;
    }

    observer ask_;
    double limit_;
    clock::time_point start_ = clock::now();
    progress now_;
    int gradients_ = 0;
    std::optional<stop> reason_;
};

} // namespace taut::solve
