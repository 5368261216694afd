// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/solve/full_objective.hpp>
#include <taut/impl/core/solve/line/line_function.hpp>
#include <taut/impl/core/solve/monitor.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

namespace taut::solve::impl
{

/// The line x + a d through an objective. It owns nothing: the trial point and the trial gradient belong to the caller,
/// who finds in them the point and gradient of the step that `land` accepted.
///
/// Slope is a callable slope(a) -> grad'd for the gradient that was just written to the trial gradient. The solver
/// passes one that fetches, in the same host wait, all products that the next direction will need.
template <objective Objective, class Slope>
class objective_line
{
public:
    using point = typename Objective::point;
    using vector = vector_of<Objective>;

    /// Point and direction of the line, and storage for trials.
    struct data
    {
        const point& x;
        const vector& d;
        point& trial;
        vector& gradient;
    };

    /// Limits of values and steps.
    struct limits
    {
        double bound;  ///< on the step
        double lowest; ///< value so far
        double noise;  ///< rounding error of a value
        int batch;     ///< values in a pass
    };

    objective_line(Objective& f, data where, Slope slope, line_point start, limits limit, monitor& watch)
        : f_(f), where_(where), slope_function_(std::move(slope)), start_(start), limits_(limit), monitor_(watch)
    {
    }

    const line_point& start() const noexcept { return start_; }
    double bound() const noexcept { return limits_.bound; }
    double noise() const noexcept { return limits_.noise; }
    double ceiling() const noexcept { return limits_.lowest + limits_.noise; }
    int batch() const noexcept { return Objective::batches ? limits_.batch : 1; }
    const line_point& best() const noexcept { return best_; }
    bool interrupted() const noexcept { return monitor_.reason().has_value(); }

    /// One evaluation: the trial point, then f there.
    double value(double a)
    {
        if (interrupted()) return infinite;
        move(a);
        return note(a, f_.value(where_.trial), 1, 0);
    }

    void values(std::span<const double> a, std::span<double> out)
    {
        if (interrupted())
            std::fill(out.begin(), out.end(), infinite);
        else if (Objective::batches)
        {
            f_.values(where_.x, where_.d, a, out);
            monitor_.count(int(a.size()), 0);
            for (std::size_t i = 0; i < a.size(); ++i) out[i] = compare(a[i], out[i]);
            monitor_.proceed();
        }
        else
            for (std::size_t i = 0; i < a.size(); ++i) out[i] = value(a[i]);
    }

    /// f and its gradient; a repeated question at the same step is answered from memory.
    double value_gradient(double a)
    {
        if (interrupted()) return infinite;
        if (a == gradient_.step)
        {
            move(a); // values may have moved the trial point since
            return gradient_.value;
        }
        move(a);
        gradient_ = {.step = a};
        gradient_.value = note(a, f_.value_gradient(where_.trial, where_.gradient), 1, 1);
        return gradient_.value;
    }

    /// Fetched on demand: a value that is too high settles a trial without its slope, and saves the wait.
    double slope()
    {
        if (std::isnan(gradient_.slope) && std::isfinite(gradient_.value))
        {
            gradient_.slope = slope_function_(gradient_.step);
            monitor_.proceed();
        }
        return gradient_.slope;
    }

private:
    static constexpr double infinite = std::numeric_limits<double>::infinity();

    void move(double a)
    {
        if (a == trial_step_) return;
        f_.step(where_.x, a, where_.d, where_.trial);
        trial_step_ = a;
    }

    /// Counts an evaluation and calls the observer, after every launch.
    double note(double a, double value, int values, int gradients)
    {
        monitor_.count(values, gradients);
        monitor_.proceed();
        return compare(a, value);
    }

    /// Outside the domain is +inf; the lowest trial is remembered.
    double compare(double a, double value)
    {
        value = finite_or_inf(value);
        if (value < best_.value) best_ = {.step = a, .value = value};
        return value;
    }

    Objective& f_;
    data where_;
    Slope slope_function_;
    line_point start_;
    limits limits_;
    monitor& monitor_;
    line_point best_;       // lowest value of all trials
    line_point gradient_;   // where value_gradient was called last; step 0: nowhere
    double trial_step_ = 0; // where the trial point is; 0: nowhere
};

} // namespace taut::solve::impl
