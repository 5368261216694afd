// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <utility>

namespace taut::detail
{

/// Seconds since the last call of lap(), for the phases of a report.
class stopwatch
{
public:
    double lap()
    {
        const auto now = clock::now();
        return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
    }
    double total() const { return std::chrono::duration<double>(clock::now() - first_).count(); }

private:
    using clock = std::chrono::steady_clock;
    clock::time_point first_ = clock::now(), last_ = first_;
};

} // namespace taut::detail
