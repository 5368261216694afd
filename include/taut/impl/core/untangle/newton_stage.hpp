// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include <taut/impl/core/untangle/epsilon_schedule.hpp>
#include <taut/impl/core/untangle/stage.hpp>

namespace taut::impl
{

/// Progress test of a stage towards an injective map: fewer inverted elements than ever, or a hundredth less of their
/// measure. Energies do not show it, as they fall with every epsilon.
class gain_watch
{
public:
    /// After a step: how many elements are inverted, and their measure.
    void note(std::size_t inverted, double measure)
    {
        const bool gained = inverted < fewest_ || measure < 0.99 * least_;
        fewest_ = std::min(fewest_, inverted);
        if (gained) least_ = std::min(least_, measure);
        idle_ = gained ? 0 : idle_ + 1;
    }

    /// Returns whether there was no gain in so many steps that epsilon was large again at least once.
    bool stuck() const { return idle_ >= 60; }

private:
    std::size_t fewest_ = std::numeric_limits<std::size_t>::max();
    double least_ = std::numeric_limits<double>::infinity();
    int idle_ = 0;
};

/// Newton's method on the regularised energy from the harmonic map, one step for each value of epsilon.
template <class Element>
class newton_stage final : public untangle_stage<Element>
{
    static constexpr int D = Element::dimension;

public:
    std::string_view name() const override { return "newton"; }

    bool run(untangle_state<Element>& state, int iterations) override
    {
        if (!newton_) start(state);
        if (state.offer(x_).flipped == 0) return false;
        for (int i = 0; i < iterations; ++i)
        {
            newton_->eps = schedule_->eps();
            const double before = newton_->value(x_);
            const double after = newton_->step(x_, before);
            state.stepped(before, after, newton_->last_length());
            if (!std::isfinite(after)) return false;
            const auto flipped = state.offer(x_).flipped;
            if (flipped == 0 || !state.proceed()) return false;
            watch_.note(flipped, newton_->inverted_measure(x_));
            if (watch_.stuck()) return false;
            standing_ = newton_->last_length() > 0 ? 0 : standing_ + 1;
            if (standing_ > 50) return false;
            schedule_->lower(before, after, newton_->last_length(), newton_->least_det(x_));
        }
        return true;
    }

private:
    void start(untangle_state<Element>& state)
    {
        const auto& problem = state.problem();
        x_ = state.harmonic();
        for (std::size_t v = 0; v < x_.size(); ++v)
            for (int k = 0; k < D; ++k)
                if (problem.held.test(v, k)) x_[v][k] = state.initial()[v][k];
        const double measure = impl::expected_measure(problem, state.initial());
        newton_ = state.make_newton(
            {.rest = problem.rest, .held = problem.held, .shapes = impl::shapes_wanted(problem, measure)});
        newton_->proceed = [&state] { return state.proceed(0); };
        schedule_ = std::make_unique<impl::epsilon_schedule>(newton_->least_det(x_));
    }

    std::unique_ptr<regularized_newton<Element>> newton_;
    std::unique_ptr<impl::epsilon_schedule> schedule_;
    impl::gain_watch watch_;
    std::vector<vec<D>> x_;
    int standing_ = 0; // steps in a row that could not be made
};

} // namespace taut::impl
