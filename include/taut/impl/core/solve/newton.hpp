// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/solve/full_objective.hpp>
#include <taut/impl/core/solve/monitor.hpp>
#include <taut/impl/core/solve/pcg.hpp>
#include <taut/impl/core/solve/stopping.hpp>
#include <taut/solve_params.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace taut::solve::impl
{

/// The loop of newton(). Truncated Newton's method with a line search (Nocedal & Wright, Algorithm 7.1): the direction
/// by preconditioned conjugate gradients, then the best of the trial steps that meets the Armijo condition.
///
/// Where the Hessian is indefinite the projected Hessian may be much too stiff: its directions are then those of
/// steepest descent in its metric, and too short. So they are made conjugate to each other, and tried at up to four
/// times their length.
///
/// | here                | meaning                                                     |
/// |---------------------|-------------------------------------------------------------|
/// | `x_, g_, value_`    | x_k, its gradient and value                                 |
/// | `d_`                | d_k                                                         |
/// | `last_d_, last_g_`  | d_{k-1} and the gradient where it began                     |
/// | `unit`              | the longest trial step: min(1, fraction of the first flip), |
/// |                     | 4 in the place of 1 along directions of the projected Hessian        |
///
/// Host waits of an iteration, 2: the products of pcg, mostly one look, and the trial steps. Where the decrease is
/// small enough to expect the end, the norm of the gradient is wanted, too: it comes with the trial steps if the full
/// step is taken, and else costs a third wait. Making directions conjugate costs one, too.
template <objective Objective>
class newton_loop
{
public:
    using point = typename Objective::point;
    using vector = vector_of<Objective>;

    newton_loop(Objective& f, point& x, const newton_params& params, const descent_params& common,
                const run_limits& limits)
        : f_(f),
          x_(x),
          params_(params),
          common_(common),
          rounding_(std::max(f_.rounding(), common.line_search.tuning.rounding)),
          monitor_(limits),
          test_(common.stopping, rounding_, patience, f_.size(0)),
          pcg_(f.space(), params.pcg),
          previous_(f.make_point()),
          full_(f.make_point()),
          g_(f.space().make()),
          d_(f.space().make()),
          last_g_(f.space().make()),
          last_d_(f.space().make()),
          full_gradient_(f.space().make()),
          system_steps_(params.pcg.max_steps),
          waits_(f_.waits())
    {
    }

    report run()
    {
        std::optional<solve::stop> reason = start();
        while (!reason) reason = iterate();
        // A run that was stopped by others between a step and its gradient's norm.
        if (pending_) settle(f_.space().dot(g_, g_));
        report_.stop = *reason;
        if (step_.capped) report_.capping = f_.capping(previous_, d_);
        report_.evaluations = monitor_.evaluations();
        report_.gradients = monitor_.gradients();
        report_.seconds = monitor_.seconds();
        report_.waits = f_.waits() - waits_;
        return std::move(report_);
    }

private:
    static constexpr int patience = 3;       // gradients fall fast or not at all
    static constexpr int longest_system = 8; // times pcg.max_steps

    std::optional<solve::stop> start()
    {
        double square;
        value_ = report_.value_start = report_.value = f_.value_gradient(x_, g_, square);
        monitor_.count(1, 1);
        const double norm = std::sqrt(square);
        if (!std::isfinite(value_) || !std::isfinite(norm)) return solve::stop::not_finite_start;
        scale_ = std::max(f_.gradient_scale(x_, norm), std::numeric_limits<double>::min());
        step_.value_before = std::numeric_limits<double>::infinity();
        record(norm);
        if (const auto reason = test_.start(norm / scale_)) return reason;
        return monitor_.reason();
    }

    std::optional<solve::stop> iterate()
    {
        const bool exact = step_.value_before - value_ < params_.exact_below * f_.size(value_);
        std::swap(d_, last_d_);
        if (auto reason = direction(exact)) return reason;
        // An indefinite Hessian may have misled; its projection does not.
        std::optional<trial> found = search();
        if (!found && exact && !monitor_.reason())
        {
            if (auto reason = direction(false)) return reason;
            found = search();
        }
        if (monitor_.reason()) return monitor_.reason();
        if (!found) return solve::stop::line_search;
        return accept(*found);
    }

    /// Computes d_ for the current point; returns a reason to stop by the norm of the gradient, which comes with it.
    std::optional<solve::stop> direction(bool exact)
    {
        f_.linearize(x_, exact);
        if (!monitor_.proceed()) return monitor_.reason();
        const bool hard = model_.looks > 1; // the last system; easy ones gain nothing by the last direction
        model_ = pcg_.solve(
            g_, [this](const vector& v, vector& out) { f_.hessian_product(v, out); },
            [this](const vector& v, vector& out) { f_.precondition(v, out); }, d_,
            [this] { return monitor_.proceed(); }, exact ? system_steps_ : 0, exact && hard ? &last_d_ : nullptr,
            noise());
        report_.products += model_.steps;
        exact_ = exact;
        if (!exact_ && along_stand_in_) conjugate();
        return pending_ ? settle(model_.gradient_squared) : std::nullopt;
    }

    /// Rounding error of values near the current one.
    double noise() const { return rounding_ * f_.size(value_); }

    /// Makes d_, a direction of the projected Hessian, conjugate to the last one (Hestenes & Stiefel 1952, with the
    /// projected Hessian as preconditioner), by the change of the gradient along that one.
    void conjugate()
    {
        const vector* const left[] = {&last_g_, &g_};
        const vector* const right[] = {&last_d_, &d_};
        std::array<double, 4> products;
        f_.space().multi_dot(left, right, products);
        const auto [before_last, before_now, after_last, after_now] = products;
        const double beta = (before_now - after_now) / (after_last - before_last);
        const double slope = after_now + beta * after_last;
        constexpr double least = 0.1; // of the slope, or the last direction has taken over
        if (!(after_last > before_last) || !(beta > 0) || !(slope < least * after_now)) return;
        f_.space().axpby(beta, last_d_, 1, d_);
        model_.slope = slope;
    }

    struct trial
    {
        double step, value;
        bool capped;
    };

    /// Chooses the step of lowest value among some, or among ever shorter ones until one meets the Armijo condition;
    /// the longest of those that are equal within rounding.
    std::optional<trial> search()
    {
        if (!(model_.slope < 0)) return std::nullopt;
        const double armijo = common_.line_search.tuning.wolfe.sufficient_decrease;
        constexpr int rounds = 8;
        double unit = 1, longest = 1;
        const bool far = !exact_;
        const double most = far ? 4 : 1;
        std::vector<double> a, values;
        for (int round = 0; round < rounds && monitor_.proceed(); ++round, longest /= 16)
        {
            a.resize(far && round == 0 ? 8 : 4);
            values.resize(a.size());
            for (std::size_t i = 0; i < a.size(); ++i)
                a[i] = longest * (a.size() > 4 ? std::exp2(-0.5 * double(i)) : std::ldexp(1.0, -int(i)));
            if (round == 0)
                unit = first_values(a, values, most);
            else
                later_values(unit, a, values);
            monitor_.count(int(a.size()), 0);
            double least = std::numeric_limits<double>::infinity();
            const auto good = [&](std::size_t i)
            { return values[i] <= value_ + armijo * unit * a[i] * model_.slope + noise(); };
            for (std::size_t i = 0; i < a.size(); ++i)
                if (good(i)) least = std::min(least, values[i]);
            for (std::size_t i = 0; i < a.size(); ++i)
                if (good(i) && values[i] <= least + noise())
                    return trial{unit * a[i], values[i], unit < most && a[i] == 1};
        }
        return std::nullopt;
    }

    /// Values at unit * a with a unit of at most `most`, which is returned.
    double first_values(std::span<const double> a, std::span<double> values, double most)
    {
        const double fraction = common_.line_search.tuning.barrier_fraction;
        full_square_.reset();
        if (near_end_ && most == 1)
            if (const auto r = f_.capped_values(x_, d_, fraction, a, values, full_, full_gradient_))
            {
                monitor_.count(0, 1);
                full_square_ = r->second;
                return r->first;
            }
        return f_.capped_values(x_, d_, fraction, a, values, most);
    }

    void later_values(double unit, std::span<const double> a, std::span<double> values)
    {
        std::vector<double> steps;
        for (const double s : a) steps.push_back(unit * s);
        f_.values(x_, d_, steps, values);
    }

    /// x_k -> x_{k+1}.
    std::optional<solve::stop> accept(const trial& t)
    {
        const bool full = full_square_ && t.step == 1;
        along_stand_in_ = !exact_;
        // Where the Hessian has proved right, a system that ends for want of steps would begin anew from what is left.
        if (!exact_ || t.step < 1)
            system_steps_ = params_.pcg.max_steps;
        else if (model_.steps >= system_steps_)
            system_steps_ = std::min(2 * system_steps_, longest_system * params_.pcg.max_steps);
        std::swap(g_, last_g_);
        std::swap(x_, previous_);
        if (full)
            std::swap(x_, full_);
        else
            f_.step(previous_, t.step, d_, x_);
        step_ = {.iteration = ++report_.iterations,
                 .value_before = std::exchange(value_, t.value),
                 .value = t.value,
                 .gradient = 0,
                 .length = t.step * std::sqrt(-model_.slope),
                 .capped = t.capped,
                 .newton = true};
        if (exact_ && !model_.negative && t.step == 1) step_.promised = model_.decrease;
        taken_ = t.step;
        constexpr double near_end = 1e-2;
        near_end_ = !(step_.value_before - value_ > near_end * f_.size(value_));
        const bool eliminates = full_objective<Objective>::eliminates && step_.iteration >= params_.eliminate_from &&
                                step_.value_before - value_ < params_.eliminate_below * f_.size(value_);
        double square = 0;
        if (full)
        {
            std::swap(g_, full_gradient_);
            square = *full_square_;
        }
        else
        {
            const bool relaxed = t.step < params_.relax_below && f_.relax(x_);
            if (!relaxed && !near_end_ && !eliminates && f_.gradient(x_, g_))
            {
                monitor_.count(0, 1);
                pending_ = true;
                return monitor_.reason();
            }
            value_ = step_.value = f_.value_gradient(x_, g_, square);
            monitor_.count(1, 1);
        }
        if (eliminates) eliminate(std::min(1.0, t.step), square);
        return settle(square);
    }

    /// Eliminates the parts that the last step, a fraction of d_, found far from quadratic: where the gradient is not
    /// (1 - share) times the one before, as it is where the model holds. square: of the gradient's norm.
    void eliminate(double share, double& square)
    {
        if (!unexpected_) unexpected_.emplace(f_.space().make());
        f_.space().copy(g_, *unexpected_);
        f_.space().axpby(share - 1, last_g_, 1, *unexpected_);
        const vector* const both[] = {&*unexpected_, &last_g_};
        std::array<double, 4> products;
        f_.space().multi_dot(both, both, products);
        const double limit = params_.eliminate_above * params_.eliminate_above * products[3];
        if (products[0] > limit && pause_-- <= 0 && std::sqrt(square) > common_.stopping.gradient_tolerance * scale_ &&
            f_.eliminate(x_, *unexpected_, [this] { return monitor_.proceed(); }))
        {
            const double before = std::exchange(value_, f_.value_gradient(x_, g_, square));
            step_.value = value_;
            monitor_.count(1, 1);
            ++report_.eliminations;
            // What brings little beside the step is left out for a while.
            constexpr double little = 0.25;
            constexpr int longest_pause = 8;
            const bool worth = before - value_ > little * (step_.value_before - before);
            pause_ = next_pause_ = worth ? 0 : std::clamp(2 * next_pause_, 1, longest_pause);
            along_stand_in_ = false; // the last direction says nothing of where x is now
        }
    }

    /// Records the last step, once its gradient is known.
    std::optional<solve::stop> settle(double gradient_squared)
    {
        pending_ = false;
        if (!std::isfinite(gradient_squared))
        {
            // The step went beyond what the arithmetic can tell from a fold.
            f_.copy(previous_, x_);
            --report_.iterations;
            return solve::stop::line_search;
        }
        const double norm = std::sqrt(gradient_squared);
        record(norm);
        step_.gradient = norm / scale_;
        const auto reason = test_.after(step_);
        return reason ? reason : monitor_.reason();
    }

    void record(double norm)
    {
        report_.value = value_;
        report_.gradient_norm = norm / scale_;
        monitor_.iterate(report_.iterations, value_, report_.gradient_norm, taken_);
        report_.history.push_back({.iteration = report_.iterations,
                                   .value = value_,
                                   .gradient = report_.gradient_norm,
                                   .step = taken_,
                                   .capped = step_.capped,
                                   .evaluations = monitor_.evaluations(),
                                   .seconds = monitor_.seconds(),
                                   .waits = f_.waits() - waits_});
    }

    full_objective<Objective> f_;
    point& x_;
    newton_params params_;
    descent_params common_;
    double rounding_;
    monitor monitor_;
    stopping_test test_;
    solve::impl::pcg<space_of<Objective>> pcg_;
    point previous_, full_; // full_: x_ + d_ and its gradient, in advance
    vector g_, d_, last_g_, last_d_, full_gradient_;
    pcg_result model_;
    step_record step_;
    double value_ = 0, scale_ = 1, taken_ = 0;
    int pause_ = 0, next_pause_ = 0;    // iterations without elimination
    std::optional<vector> unexpected_;  // of the last gradient, by the model
    std::optional<double> full_square_; // norm of full_gradient_ squared, if it came with the trial steps
    bool exact_ = false;                // d_ is of the Hessian itself
    bool along_stand_in_ = false;       // last_d_ is of the projected Hessian
    bool near_end_ = true;              // the norm of the next gradient will be wanted
    bool pending_ = false;              // the last step has no gradient norm yet
    int system_steps_ = 0;              // of PCG at most; more where the Hessian has proved right
    std::uint64_t waits_;               // before the start
    report report_;
};

/// Minimises f from x by truncated Newton's method with the preconditioner of the objective. x ends at the best
/// iterate whatever the reason to stop. Throws parameter_error, and exceptions of f and the observer.
template <objective Objective>
    requires has_hessian<Objective> report newton(Objective& f, typename Objective::point& x,
                                                  const newton_params& params = {}, const descent_params& common = {},
                                                  const run_limits& limits = {})
    {
        params.validate();
        common.validate();
        return impl::newton_loop<Objective>(f, x, params, common, limits).run();
    }

} // namespace taut::solve::impl
