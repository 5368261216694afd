// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <utility>

#include <taut/impl/dist/processes/communicator.hpp>
#include <taut/options.hpp>

namespace taut::dist::impl
{

/// Clock, observer and number of steps of a call, which end it for all processes at the same point.
class agreed_limits
{
public:
    using clock = std::chrono::steady_clock;

    agreed_limits(communicator all, run_limits limits) : all_(std::move(all)), limits_(std::move(limits)) {}

    /// Collective. Whether to go on. What an observer throws is thrown on all processes.
    bool proceed(progress p = {.iterate = false})
    {
        if (over_) return false;
        std::exception_ptr failure;
        std::int64_t wish = 0; // 1: to end, 2: failed
        try
        {
            p.seconds = seconds();
            if (limits_.observer && !limits_.observer(p)) wish = 1;
            if (!(p.seconds < limits_.time_limit.count())) wish = 1;
        }
        catch (...)
        {
            wish = 2;
            failure = std::current_exception();
        }
        wish = all_.most(wish);
        if (wish == 2) all_.fail(failure);
        over_ = wish == 1;
        return !over_;
    }

    /// What is left for a part of the call that one process does by itself.
    run_limits left() const
    {
        auto some = limits_;
        some.time_limit =
            std::max(some.time_limit - std::chrono::duration<double>(seconds()), decltype(some.time_limit)(0));
        return some;
    }

    bool over() const { return over_; }
    double seconds() const { return std::chrono::duration<double>(clock::now() - start_).count(); }

private:
    communicator all_;
    run_limits limits_;
    clock::time_point start_ = clock::now();
    bool over_ = false;
};

} // namespace taut::dist::impl
