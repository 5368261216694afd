// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <memory>
#include <string_view>
#include <utility>

#include <taut/impl/core/untangle/device/untangle_operator.hpp>
#include <taut/impl/core/untangle/stage.hpp>

namespace taut::impl
{

/// Untangling operator on the device (paper, Algorithm 2), from the best map so far; further rounds use another
/// schedule.
template <class Element>
class operator_stage final : public untangle_stage<Element>
{
public:
    explicit operator_stage(queue q) : queue_(std::move(q)) {}

    std::string_view name() const override { return "operator"; }

    bool run(untangle_state<Element>& state, int iterations) override
    {
        if (state.injective()) return false;
        if (!operator_) operator_ = std::make_unique<untangle_operator<Element>>(queue_, state.problem());
        operator_params params;
        params.iterations = iterations * moves;
        params.time_limit = std::chrono::duration<double>(state.seconds_left());
        params.observer = [&state](const progress&) { return state.proceed(0); };
        if (rounds_++ > 0)
        {
            params.schedule = operator_schedule::constant;
            params.delta = 0.05;
        }
        const auto result = operator_->run(state.best_map(), params);
        state.take(result.map);
        state.proceed(result.iterations);
        return rounds_ < 2;
    }

private:
    static constexpr int moves = 10; // of the operator that count as an iteration: they are cheap

    queue queue_;
    std::unique_ptr<untangle_operator<Element>> operator_;
    int rounds_ = 0;
};

} // namespace taut::impl
