// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

#include <doctest/doctest.h>

#include <taut/options.hpp>

namespace taut::test
{

/// The clock while a run is at work: when it was called, when its observer was first and last asked, when it ended.
class stage_watch
{
public:
    taut::observer observer()
    {
        return [this](const progress&)
        {
            last_ = clock::now();
            if (first_ == clock::time_point()) first_ = last_;
            return true;
        };
    }

    /// The stages take the time of the run, and none is lost between them: they lie inside of it and around the
    /// observer.
    template <class Stages>
    void check_complete(const Stages& stages) const
    {
        double sum = 0;
        for (const auto& s : stages) sum += s.seconds;
        constexpr double rounding = 1e-6;
        CHECK(sum <= seconds(begin_, clock::now()) + rounding);
        CHECK(sum >= seconds(first_, last_) - rounding);
        CHECK(first_ != clock::time_point());
    }

private:
    using clock = std::chrono::steady_clock;
    static double seconds(clock::time_point a, clock::time_point b)
    {
        return std::chrono::duration<double>(b - a).count();
    }

    clock::time_point begin_ = clock::now(), first_{}, last_{};
};

} // namespace taut::test
