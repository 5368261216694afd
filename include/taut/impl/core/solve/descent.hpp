// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/solve/full_objective.hpp>
#include <taut/impl/core/solve/gram.hpp>
#include <taut/impl/core/solve/line/any_line.hpp>
#include <taut/impl/core/solve/line/line_search.hpp>
#include <taut/impl/core/solve/line/objective_line.hpp>
#include <taut/impl/core/solve/stopping.hpp>
#include <taut/solve_params.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace taut::solve::impl
{

/// Use of the previous step by a method: d = -H g + on_step * s.
struct momentum
{
    double on_step = 0;
    bool restart = false; ///< the method chose to forget the step before
};

/// The rule of methods without momentum.
struct no_momentum
{
    template <class Hessian>
    momentum operator()(const Hessian&) const
    {
        return {};
    }
};

/// Descent by line searches, the loop under every method of this layer (Nocedal & Wright, section 3.1): a direction
/// d = -H g + t s, a step along it, an update of H. `Hessian` is a form of the inverse Hessian; `Rule` is a callable
/// rule(H) -> momentum, asked after H.multiply(g).
///
/// | here          | meaning                                   |
/// |---------------|-------------------------------------------|
/// | `x_, g_`      | x_k and its gradient                      |
/// | `d_`          | d_k                                       |
/// | `trial_`      | x_k + a d_k                               |
/// | `g_new_`      | its gradient                              |
/// | `bound`       | barrier fraction * max_step               |
template <objective Objective, class Hessian, class Rule>
class descent
{
public:
    using point = typename Objective::point;
    using vector = vector_of<Objective>;

    descent(Objective& f, point& x, Hessian& h, Rule rule, const descent_params& params, const run_limits& limits)
        : f_(f),
          x_(x),
          h_(h),
          rule_(std::move(rule)),
          params_(params),
          monitor_(limits),
          rounding_(std::max(f_.rounding(), params.line_search.tuning.rounding)),
          test_(params.stopping, rounding_, 10, f_.size(0)),
          trial_(f.make_point()),
          d_(f.space().make()),
          g_(f.space().make()),
          g_new_(f.space().make())
    {
    }

    /// Iterates until a reason to stop. Called once.
    report run()
    {
        std::optional<solve::stop> reason = start();
        while (!reason) reason = iterate();
        report_.stop = *reason;
        report_.evaluations = monitor_.evaluations();
        report_.gradients = monitor_.gradients();
        report_.seconds = monitor_.seconds();
        return std::move(report_);
    }

private:
    using status = search_status;

    /// Value, gradient and the scale that gradients are measured in. An optional reason, here and below: stop.
    std::optional<solve::stop> start()
    {
        value_ = lowest_ = report_.value_start = report_.value = f_.value_gradient(x_, g_);
        monitor_.count(1, 1);
        h_.start(g_);
        h_.forget(length_ = params_.first_length);
        const double norm = std::sqrt(h_.gradient_squared());
        if (!std::isfinite(value_) || !std::isfinite(norm)) return solve::stop::not_finite_start;
        linearize();

        scale_ = std::max(f_.gradient_scale(x_, norm), std::numeric_limits<double>::min());
        record({.step = 0, .value = value_}, false);
        if (const auto reason = test_.start(norm / scale_)) return reason;
        return monitor_.reason();
    }

    /// One step, or one restart.
    std::optional<solve::stop> iterate()
    {
        h_.multiply(g_);
        const momentum m = rule_(h_);
        if (m.restart) ++report_.restarts;
        const auto d = h_.direction(m.on_step, d_);
        // Only directions of descent are searched; H is positive definite, so the others come from rounding.
        if (!(d.slope < 0) || !std::isfinite(d.slope) || !std::isfinite(d.length)) return restart();

        // The barrier is ahead at a positive distance, or x_k is on it.
        const double bound = params_.line_search.tuning.barrier_fraction * f_.max_step(x_, d_);
        if (!(bound > 0)) return restart();
        // The slope at a trial comes with all inner products of the pair that the trial would make.
        const auto slope = [&](double a) { return h_.propose(a, d_, g_, g_new_); };
        const line_search_params& p = params_.line_search;
        objective_line phi(f_, {x_, d_, trial_, g_new_}, slope, {0, value_, d.slope},
                           {bound, lowest_, rounding_ * f_.size(lowest_), p.tuning.batch}, monitor_);
        any_line line(phi);
        const search_result found = search(line, std::min(1.0, bound), p, h_.fresh());

        // An interrupted search keeps x_k; a step that was accepted in the same moment is kept too.
        if (found.status == status::interrupted) return monitor_.reason();
        if (found.status == status::failed) return restart();
        return accept(found.at, found.at.step * d.length, found.at.step >= bound);
    }

    /// x_k -> x_{k+1}: the line left the point in trial_, its gradient in g_new_ and the pair proposed to H.
    std::optional<solve::stop> accept(const line_point& at, double length, bool capped)
    {
        f_.copy(trial_, x_);
        std::swap(g_, g_new_);
        if (!h_.accept()) ++report_.skipped_pairs;
        ++report_.iterations;
        length_ = length;
        if (h_.fresh()) h_.forget(length_); // the first pair was left out: at least its length is known
        if (linearizes_ && linearized_at_ - at.value > params_.linearize_after * std::abs(at.value)) linearize();
        const double before = std::exchange(value_, at.value);
        lowest_ = std::min(lowest_, value_);
        record(at, capped);

        const auto reason = test_.after({.iteration = report_.iterations,
                                         .value_before = before,
                                         .value = value_,
                                         .gradient = report_.gradient_norm,
                                         .length = length,
                                         .capped = capped});
        return reason ? reason : monitor_.reason();
    }

    /// Renews the preconditioner at x_k. Pairs belong to the old H0, so they are discarded.
    void linearize()
    {
        linearizes_ = f_.linearize(x_, false);
        if (!linearizes_) return;
        h_.forget(length_);
        linearized_at_ = value_;
    }

    /// Relaxes the elements that cut every step; returns whether that helped.
    bool relax()
    {
        if (!f_.relax(x_)) return false;
        const double before = value_;
        value_ = report_.value = f_.value_gradient(x_, g_);
        lowest_ = std::min(lowest_, value_);
        monitor_.count(1, 1);
        h_.start(g_);
        constexpr double least = 1e-6; // less, again and again, would take for ever
        return before - value_ > least * std::abs(before);
    }

    /// Discards the pairs and continues with steepest descent, in the metric of a preconditioner; gives up if that has
    /// just failed.
    std::optional<solve::stop> restart()
    {
        if (monitor_.reason()) return monitor_.reason();
        const auto stale = [this] { return linearizes_ && linearized_at_ != value_; };
        if (h_.fresh() && !stale() && !relax()) return solve::stop::line_search;
        h_.forget(length_);
        if (stale()) linearize();
        ++report_.restarts;
        return std::nullopt;
    }

    /// Records the current iterate in the report and the history, and calls the observer.
    void record(const line_point& at, bool capped)
    {
        report_.value = value_;
        report_.gradient_norm = std::sqrt(h_.gradient_squared()) / scale_;
        monitor_.iterate(report_.iterations, value_, report_.gradient_norm, at.step);
        report_.history.push_back({.iteration = report_.iterations,
                                   .value = value_,
                                   .gradient = report_.gradient_norm,
                                   .step = at.step,
                                   .capped = capped,
                                   .evaluations = monitor_.evaluations(),
                                   .seconds = monitor_.seconds()});
    }

    full_objective<Objective> f_;
    point& x_;
    Hessian& h_;
    Rule rule_;
    descent_params params_;
    monitor monitor_;
    double rounding_;
    stopping_test test_;
    point trial_;
    vector d_, g_, g_new_;
    double value_ = 0, lowest_ = 0; // f(x_k), and the lowest value so far: they differ by rounding at most
    double linearized_at_ = 0;      // the value then
    bool linearizes_ = false;       // the objective has a Hessian
    double scale_ = 1;              // gradients are relative to it
    double length_ = 1;             // of the last step
    report report_;
};

} // namespace taut::solve::impl
