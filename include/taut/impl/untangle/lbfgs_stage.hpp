// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <taut/impl/solve/minimize.hpp>
#include <taut/impl/start/harmonic.hpp>
#include <taut/impl/untangle/epsilon_schedule.hpp>
#include <taut/impl/untangle/regularized_sum.hpp>
#include <taut/impl/untangle/stage.hpp>

namespace taut::impl
{

/// L-BFGS on the regularised energy, in any dimension: some iterations for each value of epsilon, from the better of
/// the harmonic map and the best so far. Its iterations are cheap and many.
template <class Element>
class lbfgs_stage final : public untangle_stage<Element>
{
public:
    static constexpr int D = Element::dimension;

    std::string_view name() const override { return "lbfgs"; }

    bool run(untangle_state<Element>& state, int iterations) override
    {
        if (!energy_) start(state);
        if (state.injective()) return false;
        for (int i = 0; i < iterations; ++i)
        {
            energy_->eps = schedule_->eps();
            solve::host_objective objective(x_.size(), [this](std::span<const double> x, std::span<double> g)
                                            { return energy_->value_gradient(x, g); });
            solve::params params;
            params.method = solve::method::lbfgs;
            params.stopping.max_iterations = inner;
            params.stopping.time_limit = std::chrono::duration<double>(std::max(1e-3, state.seconds_left()));
            params.tuning.first_length = 0.01;
            const solve::report report = solve::minimize(objective, x_, params);
            state.stepped(report.value_start, report.value, 0);
            if (!std::isfinite(report.value)) return false;
            if (state.offer(points()).flipped == 0 || !state.proceed()) return false;
            standing_ = report.value < report.value_start ? 0 : standing_ + 1;
            if (standing_ > 50) return false;
            schedule_->lower(report.value_start, report.value, 0.1, energy_->least_det(x_));
        }
        return true;
    }

private:
    static constexpr int inner = 25; // iterations at one epsilon

    void start(untangle_state<Element>& state)
    {
        const auto& problem = state.problem();
        const auto& harmonic = state.harmonic();
        const auto before = state.flips().flipped;
        const auto best = state.offer(harmonic).flipped <= before ? harmonic : state.best();
        for (const auto& p : best)
            for (int k = 0; k < D; ++k) x_.push_back(p[k]);
        energy_ = std::make_unique<impl::regularized_sum<Element>>(problem.rest, problem.held);
        energy_->shapes = impl::shapes_wanted(problem, impl::expected_measure(problem, state.initial()));
        schedule_ = std::make_unique<impl::epsilon_schedule>(energy_->least_det(x_));
    }

    std::vector<vec<D>> points() const
    {
        std::vector<vec<D>> result(x_.size() / D);
        for (std::size_t v = 0; v < result.size(); ++v)
            for (int k = 0; k < D; ++k) result[v][k] = x_[D * v + static_cast<std::size_t>(k)];
        return result;
    }

    std::unique_ptr<impl::regularized_sum<Element>> energy_;
    std::unique_ptr<impl::epsilon_schedule> schedule_;
    std::vector<double> x_;
    int standing_ = 0; // minimisations in a row that lowered nothing
};

} // namespace taut::impl
