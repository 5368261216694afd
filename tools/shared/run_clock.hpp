// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>

namespace taut::tools
{

/// Wall-clock seconds since the program was started.
class run_clock
{
public:
    explicit run_clock(std::chrono::steady_clock::time_point launch) : launch_(launch) {}

    double now() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - launch_).count(); }

    /// Remaining part of a limit of seconds since the start, positive for solvers.
    std::chrono::duration<double> left(double limit) const
    {
        return std::chrono::duration<double>(std::max(1e-6, limit - now()));
    }

    /// Seconds that f takes.
    template <class F>
    double timed(F&& f) const
    {
        const double begin = now();
        f();
        return now() - begin;
    }

private:
    std::chrono::steady_clock::time_point launch_;
};

} // namespace taut::tools
