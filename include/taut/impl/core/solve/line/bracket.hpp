// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/solve/line/line_function.hpp>
#include <taut/solve_params.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace taut::solve::impl
{

/// The triplet (x_a, x_b, x_c) of the paper's section 3.2: steps a < b < c with phi(b) below phi(a) and phi(c).
struct bracket_triplet
{
    bool found = false;
    bool capped = false; ///< the value still falls at the bound of a barrier: b = c = bound
    double a = 0, b = 0, c = 0;
    double value = 0; ///< phi(b)
};

/// Several trial steps in one pass: a ladder from a step by a factor, no rung beyond the bound.
class ladder
{
public:
    template <line_function Line>
    ladder(Line& phi, double from, double factor)
    {
        const auto batch = std::size_t(std::clamp(phi.batch(), 1, line_tuning::most_batch));
        for (double a = from; rungs_ < batch && (factor < 1 || a < phi.bound());)
        {
            a = std::min(a * factor, phi.bound());
            if (!(a > 0) || !std::isfinite(a)) break; // left the range of double
            step_[rungs_++] = a;
        }
        if (rungs_ > 0) phi.values(std::span(step_.data(), rungs_), std::span(value_.data(), rungs_));
    }

    std::size_t size() const noexcept { return rungs_; }
    line_point operator[](std::size_t i) const { return {.step = step_[i], .value = value_[i]}; }

private:
    std::array<double, line_tuning::most_batch> step_{}, value_{};
    std::size_t rungs_ = 0;
};

/// While the value falls: longer steps. `at` is below phi(0).
template <line_function Line>
bracket_triplet bracket_up(Line& phi, line_point at, double growth, int passes)
{
    line_point before = phi.start();
    if (at.step >= phi.bound()) return {true, true, 0, at.step, at.step, at.value};
    for (; passes > 0 && !phi.interrupted(); --passes)
    {
        const ladder trial(phi, at.step, growth);
        if (trial.size() == 0) break;
        // Later rungs of a pass are ignored once a rise is found: they may lie in another valley.
        for (std::size_t i = 0; i < trial.size(); ++i)
        {
            if (trial[i].value >= at.value) return {true, false, before.step, at.step, trial[i].step, at.value};
            before = at;
            at = trial[i];
        }
        if (at.step >= phi.bound()) return {true, true, before.step, at.step, at.step, at.value};
    }
    return {};
}

/// While the value is not below phi(0): shorter steps. The first rung below it is a triplet with 0 and its longer
/// neighbour; shorter rungs that the same pass computed tighten it.
template <line_function Line>
bracket_triplet bracket_down(Line& phi, line_point at, double growth, int passes)
{
    for (; passes > 0 && !phi.interrupted() && !lost_in_rounding(phi, at.step); --passes)
    {
        const ladder trial(phi, at.step, 1 / growth);
        if (trial.size() == 0) break;
        for (std::size_t i = 0; i < trial.size(); ++i)
        {
            const bool last = i + 1 == trial.size();
            const bool lowest = last || trial[i + 1].value >= trial[i].value;
            if (trial[i].value < phi.start().value && lowest)
                return {true, false, last ? 0 : trial[i + 1].step, trial[i].step, at.step, trial[i].value};
            at = trial[i];
        }
    }
    return {};
}

/// Brackets a minimum of phi from a first trial of known value: a ladder of ever longer steps while the value falls,
/// or of ever shorter ones until it is below phi(0), each `growth` times the last. Lines with batches evaluate several
/// rungs in a pass; at most `passes` passes are made, and no step is beyond the bound.
///
/// The paper walks from small steps up to find where its energy is defined; with the exact barrier as bound that is
/// known, and an infinite value is just a high one.
template <line_function Line>
bracket_triplet bracket(Line& phi, const line_point& first, double growth, int passes)
{
    return first.value < phi.start().value ? impl::bracket_up(phi, first, growth, passes)
                                           : impl::bracket_down(phi, first, growth, passes);
}

} // namespace taut::solve::impl
