// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/error.hpp>
#include <taut/impl/solve/tuning.hpp>

#include <chrono>
#include <cmath>
#include <limits>

namespace taut::solve::impl
{

/// Constants of the Wolfe conditions (Nocedal & Wright, Numerical Optimization, 2nd ed., section 3.1).
struct wolfe_params
{
    /// c1: minimum decrease, as a fraction of that predicted by the slope. Range (0, 0.5). Hardly ever worth a change.
    double sufficient_decrease = 1e-4;

    /// c2: maximum remaining slope, as a fraction of the initial one. Range (c1, 1). 0.9 for quasi-Newton directions;
    /// 0.1 makes searches nearly exact, which suits plain conjugate gradients.
    double curvature = 0.9;

    friend bool operator==(const wolfe_params&, const wolfe_params&) = default;

    void validate() const
    {
        if (!(sufficient_decrease > 0 && sufficient_decrease < 0.5))
            throw parameter_error("wolfe.sufficient_decrease", "must be in (0, 0.5)");
        if (!(curvature > sufficient_decrease && curvature < 1))
            throw parameter_error("wolfe.curvature", "must be between sufficient_decrease and 1");
    }
};

} // namespace taut::solve::impl

namespace taut::solve
{

enum class line_search_method : int;

} // namespace taut::solve

namespace taut::solve::impl
{

// solve/line/line_search.hpp has their names, and includes them

/// Line search parameters of the descent methods. Newton's method has a search of its own, which takes
/// wolfe.sufficient_decrease, barrier_fraction and rounding alone.
struct line_search_params
{
    /// hybrid, the default, where values are cheaper than gradients; strong_wolfe where they come together anyway.
    line_search_method method{};

    wolfe_params wolfe = {};

    /// Maximum trial step as a fraction of the step to the barrier (objectives with max_step). Range (0, 1); 0.9 to
    /// 0.99 are sensible: nearer to 1 the energy at the end of the step explodes.
    double barrier_fraction = 0.9;

    /// Not for users: what tests and measurements set.
    impl::line_tuning tuning = {};

    friend bool operator==(const line_search_params&, const line_search_params&) = default;

    void validate() const
    {
        wolfe.validate();
        if (!(barrier_fraction > 0 && barrier_fraction < 1))
            throw parameter_error("line_search.barrier_fraction", "must be in (0, 1)");
        tuning.validate();
    }
};

/// Stopping criteria. A tolerance of 0 switches its test off.
struct stopping_params
{
    /// Stop where |g| <= gradient_tolerance * scale; the scale is the objective's gradient_scale or |g| at the start.
    /// Range [0, 1). Lower it for results to more digits; below 1e-8 rounding of the gradient may win.
    ///
    /// A gradient is long where f is steep, not where much is left to gain. Newton's method stops, too, where the
    /// Hessian promises, twice in a row, a decrease of at most 1e-2 gradient_tolerance * |f - base|:
    /// Newton's decrement, which is the same in all units and scalings (Boyd & Vandenberghe 2004, 9.5).
    double gradient_tolerance = 1e-6;

    /// Stop after two (tuning.decrease_count) decreases in a row of at most decrease_tolerance * |f - base|. A decrease
    /// along a step that a barrier cut is not counted; one that is lost in rounding is counted only where the gradient
    /// has reached no new low for ten steps (three of Newton's method). Range [0, 1). Raise it (1e-6) to stop where the
    /// value, not the point, matters.
    double decrease_tolerance = 1e-14;

    /// Newton's method: stop where five steps in a row, each of which ended at a relative gradient of at most 1e-2,
    /// have together gained at most settled_tolerance * |f - base|, unless the last one was a full step along a
    /// definite Hessian, after which the end is near anyway. For long valleys with negligible decrease at their end
    /// (docs/explanation/numerics.md, "Stopping criteria"). Range [0, 1); off here, on by default in maps of surfaces.
    double settled_tolerance = 0;

    /// Stop after two uncapped steps in a row of at most step_tolerance * the longest step of the run.
    /// Range [0, 1); off by default.
    double step_tolerance = 0;

    /// Range >= 0.
    int max_iterations = 10000;

    /// Range > 0; infinite by default. The current evaluation is always finished.
    std::chrono::duration<double> time_limit{std::numeric_limits<double>::infinity()};

    /// Not for users: what tests and measurements set.
    impl::stopping_tuning tuning = {};

    void validate() const
    {
        const auto fraction = [](double t, const char* field)
        {
            if (!(t >= 0 && t < 1)) throw parameter_error(field, "must be in [0, 1)");
        };
        fraction(gradient_tolerance, "stopping.gradient_tolerance");
        fraction(decrease_tolerance, "stopping.decrease_tolerance");
        fraction(settled_tolerance, "stopping.settled_tolerance");
        fraction(step_tolerance, "stopping.step_tolerance");
        tuning.validate();
        if (max_iterations < 0) throw parameter_error("stopping.max_iterations", "must not be negative");
        if (!(time_limit.count() > 0)) throw parameter_error("stopping.time_limit", "must be positive");
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

/// Choice of the factor gamma of H0 = gamma I (or gamma times the objective's own H0).
enum class scaling
{
    newest, ///< s'y / y'H0 y of the newest pair (Nocedal & Wright, 7.20)
    largest ///< the larger of those of the oldest and the newest pair: the paper's [24] as its authors use it
};

/// Parameters of the limited memory of L-BFGS and of the preconditioned conjugate gradient method.
struct memory_params
{
    /// m: pairs (s, y) kept. Range 0..64; 0 leaves H0. 5 to 20 are usual: more memory, fewer iterations.
    int pairs = 8;

    solve::impl::scaling scaling = solve::impl::scaling::newest;

    /// A pair with s'y <= cautious |s| |y| is left out (Li & Fukushima 2001), which keeps H positive definite.
    /// Range [0, 1). Raise it where gradients are noisy.
    double cautious = 1e-8;

    void validate() const
    {
        if (pairs < 0 || pairs > 64) throw parameter_error("memory.pairs", "must be in 0..64");
        if (!(cautious >= 0 && cautious < 1)) throw parameter_error("memory.cautious", "must be in [0, 1)");
    }
};

/// Parameters of the limited-memory BFGS method.
struct lbfgs_params
{
    memory_params memory = {};

    void validate() const { memory.validate(); }
};

/// beta of the conjugate directions, in the inner product of the preconditioner H = H_{k+1}. Negative ones, which
/// inexact searches that stop short produce, become 0 (Nocedal & Wright, 5.45, for either formula).
enum class conjugacy
{
    hestenes_stiefel, ///< y'H g_{k+1} / y'd_k: the paper's
    polak_ribiere     ///< y'H g_{k+1} / g_k'H g_k: "PR+"
};

/// Parameters of the paper's preconditioned nonlinear conjugate gradient method.
struct conjugate_gradient_params
{
    impl::conjugacy beta = impl::conjugacy::hestenes_stiefel;

    /// The preconditioner: m pairs of L-BFGS (the paper compares several m, Figure 7; its released code takes 1). 0 is
    /// the plain method.
    memory_params memory = {.pairs = 5, .scaling = scaling::largest};

    /// Number of iterations between restarts. Range >= 0; 0: only where the direction does not descend or the line
    /// search fails. The number of unknowns is the classic choice for the plain method on small problems.
    int restart_interval = 0;

    void validate() const
    {
        memory.validate();
        if (restart_interval < 0) throw parameter_error("conjugate_gradient.restart_interval", "must not be negative");
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

/// Parameters of minimize(), by algorithm. Nested aggregates with defaults:
///
///     minimize(f, x, {.method = method::conjugate_gradient, .stopping = {.gradient_tolerance = 1e-8}});
struct params
{
    solve::method method = solve::method::automatic;
    impl::lbfgs_params lbfgs = {};
    impl::conjugate_gradient_params conjugate_gradient = {};
    impl::line_search_params line_search = {};
    impl::stopping_params stopping = {};

    /// Not for users: what tests and measurements set.
    impl::tuning tuning = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        tuning.newton.validate();
        lbfgs.validate();
        conjugate_gradient.validate();
        common().validate();
        if (method == solve::method::newton) require_newton_search();
    }

    /// Throws parameter_error where a parameter is set that Newton's method does not use.
    void require_newton_search() const
    {
        const impl::descent_params unset;
        const impl::line_search_params used{.wolfe = {.sufficient_decrease = line_search.wolfe.sufficient_decrease},
                                            .barrier_fraction = line_search.barrier_fraction,
                                            .tuning = {.rounding = line_search.tuning.rounding}};
        if (line_search == used && tuning.first_length == unset.first_length &&
            tuning.linearize_after == unset.linearize_after)
            return;
        throw parameter_error("line_search", "Newton's method takes wolfe.sufficient_decrease, barrier_fraction and "
                                             "rounding alone; leave the rest as "
                                             "they are, or choose another method");
    }

    impl::descent_params common() const
    {
        return {.line_search = line_search,
                .stopping = stopping,
                .first_length = tuning.first_length,
                .linearize_after = tuning.linearize_after};
    }
};

} // namespace taut::solve
