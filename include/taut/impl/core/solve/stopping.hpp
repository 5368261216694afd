// SPDX-License-Identifier: MIT
#pragma once

#include <taut/solve_params.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace taut::solve::impl
{

/// Record of an accepted step, for the stopping tests.
struct step_record
{
    int iteration = 0;       ///< 1 for the first step
    double value_before = 0; ///< f(x_k)
    double value = 0;        ///< f(x_{k+1})
    double gradient = 0;     ///< relative norm at x_{k+1}
    double length = 0;       ///< |s_k|
    bool capped = false;     ///< cut by a barrier

    /// Half the square of the Newton decrement: the decrease predicted by the Hessian itself, where it was positive
    /// definite, for a full step.
    double promised = std::numeric_limits<double>::infinity();

    bool newton = false; ///< a step of Newton's method, of which few are worth much
};

/// The tests of stopping_params over a run, with their memory of the steps before.
class stopping_test
{
public:
    /// rounding: error of a value by the larger of the value and value_scale. patience: steps without a new low of the
    /// gradient after which decreases that are lost in rounding count; gradients of quasi-Newton methods fall in waves.
    stopping_test(const stopping_params& params, double rounding, int patience = 10, double value_scale = 0)
        : params_(params), rounding_(rounding), value_scale_(value_scale), patience_(patience)
    {
    }

    /// Tests the initial point.
    std::optional<stop> start(double gradient)
    {
        lowest_gradient_ = gradient;
        if (small_gradient(gradient)) return stop::gradient;
        if (params_.max_iterations == 0) return stop::iterations;
        return std::nullopt;
    }

    std::optional<stop> after(const step_record& k)
    {
        if (small_gradient(k.gradient)) return stop::gradient;

        const double scale = std::max({std::abs(k.value), std::abs(k.value_before), value_scale_});
        const double decrease = k.value_before - k.value;
        const bool lost = decrease <= rounding_ * scale;
        const bool small = params_.decrease_tolerance > 0 &&
                           (lost || decrease <= params_.decrease_tolerance * std::abs(k.value - params_.tuning.base));
        since_low_ = k.gradient < 0.99 * lowest_gradient_ ? 0 : since_low_ + 1;
        lowest_gradient_ = std::min(lowest_gradient_, k.gradient);
        const bool falling = lost && since_low_ < patience_;
        longest_ = std::max(longest_, k.length);

        capped_ = small && k.capped ? capped_ + 1 : 0;
        if (!small)
            decreases_ = 0;
        else if (!k.capped && !falling)
            ++decreases_;
        const bool short_step =
            params_.tuning.step_tolerance > 0 && k.length <= params_.tuning.step_tolerance * longest_;
        steps_ = short_step && !k.capped ? steps_ + 1 : 0;
        promises_ = k.promised <= promise * params_.gradient_tolerance * std::abs(k.value - params_.tuning.base)
                        ? promises_ + 1
                        : 0;

        if (promises_ >= params_.tuning.decrease_count) return stop::decrement;
        if (settled(k)) return stop::settled;
        if (decreases_ >= params_.tuning.decrease_count) return stop::decrease;
        if (steps_ >= params_.tuning.decrease_count) return stop::step;
        if (capped_ >= params_.tuning.barrier_count) return stop::barrier;
        if (k.iteration >= params_.max_iterations) return stop::iterations;
        return std::nullopt;
    }

private:
    static constexpr double promise = 1e-2; // see stopping_params::gradient_tolerance
    static constexpr double settled_gradient = 1e-2;

    bool settled(const step_record& k)
    {
        values_[steps_seen_++ % values_.size()] = k.value_before;
        near_ = k.newton && k.gradient <= settled_gradient ? near_ + 1 : 0;
        const double gain = values_[steps_seen_ % values_.size()] - k.value;
        return params_.tuning.settled_tolerance > 0 && near_ >= values_.size() && std::isinf(k.promised) &&
               gain <= params_.tuning.settled_tolerance * std::abs(k.value - params_.tuning.base);
    }

    bool small_gradient(double gradient) const { return gradient == 0 || gradient <= params_.gradient_tolerance; }

    stopping_params params_;
    double rounding_, value_scale_;
    int patience_;
    double lowest_gradient_ = std::numeric_limits<double>::infinity();
    double longest_ = 0;
    std::array<double, 5> values_{};        // before each of the last steps
    std::size_t steps_seen_ = 0, near_ = 0; // near_: steps in a row that ended at a small gradient
    int since_low_ = 0;                     // steps since the lowest gradient
    int decreases_ = 0, promises_ = 0, steps_ = 0, capped_ = 0;
};

} // namespace taut::solve::impl
