// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/mesh/wanted_shapes.hpp>
#include <taut/impl/start/laid.hpp>
#include <taut/impl/untangle/epsilon_schedule.hpp>
#include <taut/impl/untangle/gain_watch.hpp>
#include <taut/impl/untangle/stage.hpp>

namespace taut::impl
{

/// Initial maps of a stage.
enum class untangle_start
{
    best,     ///< the better of the initial map and the best so far
    harmonic, ///< each free coordinate the mean of its neighbours'
    laid      ///< an injective map that ignores fixed coordinates, brought near to it; for few fixed vertices
};

/// Variants of the stage below.
struct newton_stage_params
{
    std::string name;
    untangle_start start = untangle_start::best;
    wanted_shapes shapes = wanted_shapes::rest;
    double area_weight = 1; ///< of det + 1 / det against the shape of a triangle; 0: shape alone
};

/// Newton's method on the regularised energy, one step for each value of epsilon.
template <class Element>
class newton_stage final : public untangle_stage<Element>
{
    static constexpr int D = Element::dimension;

public:
    explicit newton_stage(newton_stage_params params) : params_(std::move(params)) {}

    std::string_view name() const override { return params_.name; }

    bool run(untangle_state<Element>& state, int iterations) override
    {
        if (!newton_ && !start(state)) return false;
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
    /// Starts the stage; returns false if there is no such start.
    bool start(untangle_state<Element>& state)
    {
        const auto& problem = state.problem();
        if (params_.start == untangle_start::best)
            x_ = state.best();
        else if (params_.start == untangle_start::harmonic)
            x_ = state.harmonic();
        else if (!lay(state))
            return false;
        for (std::size_t v = 0; v < x_.size(); ++v)
            for (int k = 0; k < D; ++k)
                if (problem.held.test(v, k)) x_[v][k] = state.initial()[v][k];
        const double measure = impl::expected_measure(problem, state.initial());
        newton_ = state.make_newton({.rest = problem.rest,
                                     .held = problem.held,
                                     .shapes = params_.shapes == wanted_shapes::rest
                                                   ? impl::shapes_wanted(problem, measure)
                                                   : impl::regular_shapes(problem.rest, measure),
                                     .area_weight = params_.area_weight});
        newton_->proceed = [&state] { return state.proceed(0); };
        schedule_ = std::make_unique<impl::epsilon_schedule>(newton_->least_det(x_));
        return true;
    }

    /// Starts from an injective map that ignores fixed coordinates; returns false if there is none.
    bool lay(untangle_state<Element>& state)
    {
        if constexpr (D == 2)
            if (auto laid = impl::laid_start(state.problem(), state.initial(), state.draft()))
            {
                x_ = std::move(*laid);
                return true;
            }
        return false;
    }

    newton_stage_params params_;
    std::unique_ptr<regularized_newton<Element>> newton_;
    std::unique_ptr<impl::epsilon_schedule> schedule_;
    impl::gain_watch watch_;
    std::vector<vec<D>> x_;
    int standing_ = 0; // steps in a row that could not be made
};

} // namespace taut::impl
