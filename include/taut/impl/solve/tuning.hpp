// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/error.hpp>

/// Numbers of the solvers that no user has a reason to set: tests and measurements do.
namespace taut::solve::impl
{

/// Parameters of the exact part of the paper's line search.
struct exact_params
{
    /// Relative tolerance of Brent's method on the step. Range (0, 1); below 1.5e-8 it means 1.5e-8.
    double tolerance = 1e-6;

    /// Evaluations of Brent's method. Range >= 0; more only where values are much cheaper than gradients.
    int evaluations = 8;

    /// The same two for the first iteration and after a restart, where the length of the direction means little.
    double first_tolerance = 1e-16;
    int first_evaluations = 30;

    /// Factor between trial steps while a minimum is bracketed. Range > 1.
    double growth = 4;

    /// Passes of bracketing, each one evaluation, or one batch of them. Range >= 1.
    int bracket_passes = 30;

    friend bool operator==(const exact_params&, const exact_params&) = default;

    void validate() const
    {
        if (!(tolerance > 0 && tolerance < 1)) throw parameter_error("exact.tolerance", "must be in (0, 1)");
        if (!(first_tolerance > 0 && first_tolerance < 1))
            throw parameter_error("exact.first_tolerance", "must be in (0, 1)");
        if (evaluations < 0) throw parameter_error("exact.evaluations", "must not be negative");
        if (first_evaluations < 0) throw parameter_error("exact.first_evaluations", "must not be negative");
        if (!(growth > 1)) throw parameter_error("exact.growth", "must be above 1");
        if (bracket_passes < 1) throw parameter_error("exact.bracket_passes", "must be at least 1");
    }
};

/// Tuning of all line searches.
struct line_tuning
{
    exact_params exact = {};

    static constexpr int most_batch = 16;

    /// Trial steps in one pass where the objective has `values`. Range 1..most_batch.
    int batch = 6;

    /// Maximum number of gradients of strong_wolfe, or of values of backtracking. Range >= 1.
    int max_evaluations = 30;

    /// Factor between the steps of backtracking. Range (0, 1).
    double shrink = 0.5;

    /// Relative rounding error of a value. Changes below this are noise; decreases are then tested by the slope
    /// (approximate Wolfe conditions, Hager and Zhang). Range [0, 1e-3). An objective that computes in float has its
    /// own rounding(), and the larger one applies.
    double rounding = 1e-14;

    friend bool operator==(const line_tuning&, const line_tuning&) = default;

    void validate() const
    {
        exact.validate();
        if (batch < 1 || batch > most_batch) throw parameter_error("line_search.batch", "must be in 1..16");
        if (max_evaluations < 1) throw parameter_error("line_search.max_evaluations", "must be at least 1");
        if (!(shrink > 0 && shrink < 1)) throw parameter_error("line_search.shrink", "must be in (0, 1)");
        if (!(rounding >= 0 && rounding < 1e-3)) throw parameter_error("line_search.rounding", "must be in [0, 1e-3)");
    }
};

/// Tuning of the stopping tests.
struct stopping_tuning
{
    /// Lower bound of f, or 0. Decreases are judged relative to f - base, not to f.
    double base = 0;

    /// Range >= 1. One small decrease is often an accident of the line search.
    int decrease_count = 2;

    /// Stop with stop::barrier after so many steps in a row that a barrier cut and that gained less than
    /// decrease_tolerance. Range >= 1.
    int barrier_count = 10;

    void validate() const
    {
        if (decrease_count < 1) throw parameter_error("stopping.decrease_count", "must be at least 1");
        if (barrier_count < 1) throw parameter_error("stopping.barrier_count", "must be at least 1");
    }
};

/// Parameters of conjugate gradients on a Newton system.
struct pcg_params
{
    /// Maximum number of products with the matrix, and with the preconditioner. Range 1..1000. Newton's method doubles
    /// it, up to eightfold, after each full step along the Hessian itself whose system took them all.
    int max_steps = 40;

    /// Maximum number of steps between two convergence tests, each of which is a host wait. The first system is tested
    /// after two, each further one after as many as the previous one needed. Range 1..8.
    int block = 6;

    /// Stop when the last decrease of the model is below this fraction of the mean decrease (Nash & Sofer 1990,
    /// "Assessing a search direction within a truncated-Newton method"); of later blocks, their mean step. Range (0,
    /// 1). Lower it for more exact directions.
    double gain = 0.25;

    void validate() const
    {
        if (max_steps < 1 || max_steps > 1000) throw parameter_error("pcg.max_steps", "must be in 1..1000");
        if (block < 1 || block > 8) throw parameter_error("pcg.block", "must be in 1..8");
        if (!(gain > 0 && gain < 1)) throw parameter_error("pcg.gain", "must be in (0, 1)");
    }
};

/// Parameters of Newton's method with inexact directions.
struct newton_params
{
    pcg_params pcg = {};

    /// Relative decrease of the value per iteration below which the Hessian itself replaces the projected one: near a
    /// minimum it halves the iterations, far from one it misleads. Range [0, 1).
    double exact_below = 1e-5;

    /// Step length below which the objective relaxes the elements that cut the step. Range [0, 1].
    double relax_below = 0.5;

    /// First iteration, and relative decrease of the value, from which the objective eliminates strongly nonlinear
    /// parts, whose gradients differ from the model's. Ranges >= 1 and >= 0; 0: never.
    int eliminate_from = 10;
    double eliminate_below = 1e-3;
    /// Minimum length of that difference relative to the previous gradient. Range > 0.
    double eliminate_above = 0.3;

    void validate() const
    {
        pcg.validate();
        if (!(exact_below >= 0 && exact_below < 1)) throw parameter_error("newton.exact_below", "must be in [0, 1)");
        if (!(relax_below >= 0 && relax_below <= 1)) throw parameter_error("newton.relax_below", "must be in [0, 1]");
        if (!(eliminate_from >= 1)) throw parameter_error("newton.eliminate_from", "must be at least 1");
        if (!(eliminate_below >= 0)) throw parameter_error("newton.eliminate_below", "must be at least 0");
        if (!(eliminate_above > 0)) throw parameter_error("newton.eliminate_above", "must be above 0");
    }
};

/// Tuning of minimize().
struct tuning
{
    newton_params newton = {};
    double first_length = 1;       ///< as in descent_params
    double linearize_after = 0.03; ///< as in descent_params
};

} // namespace taut::solve::impl
