// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/error.hpp>
#include <taut/impl/solve/tuning.hpp>

#include <cmath>

namespace taut::solve
{

enum class line_search_method : int;

} // namespace taut::solve

namespace taut::solve::impl
{

// solve/line/line_search.hpp has their names, and includes them

/// Line search of the descent methods. Newton's method has a search of its own, which takes wolfe.sufficient_decrease,
/// barrier_fraction and rounding of the tuning alone.
struct line_search_params
{
    line_search_method method{};
    line_tuning tuning = {};

    friend bool operator==(const line_search_params&, const line_search_params&) = default;

    void validate() const { tuning.validate(); }
};

/// Stopping criteria, as in solve::params.
struct stopping_params
{
    double gradient_tolerance = 1e-6;
    double decrease_tolerance = 1e-14;
    int max_iterations = 10000;
    stopping_tuning tuning = {};

    void validate() const
    {
        const auto fraction = [](double t, const char* field)
        {
            if (!(t >= 0 && t < 1)) throw parameter_error(field, "must be in [0, 1)");
        };
        fraction(gradient_tolerance, "gradient_tolerance");
        fraction(decrease_tolerance, "decrease_tolerance");
        tuning.validate();
        if (max_iterations < 0) throw parameter_error("max_iterations", "must not be negative");
    }
};

/// Common parameters of all descent methods.
struct descent_params
{
    solve::impl::line_search_params line_search = {};
    stopping_params stopping = {};

    /// Length of the first direction, a guess of the distance to go; a wrong one costs trial steps in the first
    /// iteration only. Range > 0. Unused with a preconditioner, whose scale is trusted.
    double first_length = 1;

    /// Relative decrease of the value after which an objective with a Hessian renews its preconditioner, and the method
    /// discards its pairs. Range > 0.
    double linearize_after = 0.03;

    void validate() const
    {
        line_search.validate();
        stopping.validate();
        if (!(first_length > 0) || !std::isfinite(first_length))
            throw parameter_error("first_length", "must be positive and finite");
        if (!(linearize_after > 0)) throw parameter_error("linearize_after", "must be positive");
    }
};

} // namespace taut::solve::impl

namespace taut::solve
{

/// Minimisation methods.
enum class method
{
    automatic,          ///< newton where the objective has a Hessian, else lbfgs
    newton,             ///< truncated Newton: objectives with a Hessian only
    lbfgs,              ///< limited-memory BFGS, preconditioned where the objective can
    conjugate_gradient, ///< the paper's preconditioned nonlinear conjugate gradient
    gradient_descent    ///< steepest descent, for comparison
};

/// Parameters of minimize(). A tolerance of 0 switches its test off.
///
///     minimize(f, x, {.method = method::conjugate_gradient, .gradient_tolerance = 1e-8});
struct params
{
    solve::method method = solve::method::automatic;

    /// Line search of the descent methods: hybrid, the default, where values are cheaper than gradients; strong_wolfe
    /// where they come together anyway.
    line_search_method line_search{};

    /// Stop where |g| <= gradient_tolerance * scale; the scale is the objective's gradient_scale or |g| at the start.
    /// Range [0, 1). Lower it for results to more digits; below 1e-8 rounding of the gradient may win.
    ///
    /// A gradient is long where f is steep, not where much is left to gain. Newton's method stops, too, where the
    /// Hessian promises, twice in a row, a decrease of at most 1e-2 gradient_tolerance * |f - base|:
    /// Newton's decrement, which is the same in all units and scalings (Boyd & Vandenberghe 2004, 9.5).
    double gradient_tolerance = 1e-6;

    /// Stop after two decreases in a row of at most decrease_tolerance * |f - base|. A decrease along a step that a
    /// barrier cut is not counted; one that is lost in rounding is counted only where the gradient has reached no new
    /// low for ten steps (three of Newton's method). Range [0, 1). Raise it (1e-6) to stop where the value, not the
    /// point, matters.
    double decrease_tolerance = 1e-14;

    /// Range >= 0.
    int max_iterations = 10000;

    /// Not for users: what tests and measurements set.
    impl::tuning tuning = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        tuning.newton.validate();
        tuning.lbfgs.validate();
        tuning.conjugate_gradient.validate();
        common().validate();
        if (method == solve::method::newton) require_newton_search();
    }

    /// Throws parameter_error where a parameter is set that Newton's method does not use.
    void require_newton_search() const
    {
        const impl::tuning unset;
        const impl::line_tuning& line = tuning.line;
        const impl::line_tuning used{.wolfe = {.sufficient_decrease = line.wolfe.sufficient_decrease},
                                     .barrier_fraction = line.barrier_fraction,
                                     .rounding = line.rounding};
        if (line_search == line_search_method{} && line == used && tuning.first_length == unset.first_length &&
            tuning.linearize_after == unset.linearize_after)
            return;
        throw parameter_error("line_search", "Newton's method takes wolfe.sufficient_decrease, barrier_fraction and "
                                             "rounding alone; leave the rest as "
                                             "they are, or choose another method");
    }

    impl::descent_params common() const
    {
        return {.line_search = {line_search, tuning.line},
                .stopping = {gradient_tolerance, decrease_tolerance, max_iterations, tuning.stopping},
                .first_length = tuning.first_length,
                .linearize_after = tuning.linearize_after};
    }
};

} // namespace taut::solve
