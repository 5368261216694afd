// SPDX-License-Identifier: MIT
#pragma once

#include <taut/errors.hpp>

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

/// Tuning of all line searches.
struct line_tuning
{
    wolfe_params wolfe = {};

    /// Maximum trial step as a fraction of the step to the barrier (objectives with max_step). Range (0, 1); 0.9 to
    /// 0.99 are sensible: nearer to 1 the energy at the end of the step explodes.
    double barrier_fraction = 0.9;

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
        wolfe.validate();
        if (!(barrier_fraction > 0 && barrier_fraction < 1))
            throw parameter_error("line_search.barrier_fraction", "must be in (0, 1)");
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

    /// Newton's method: stop where five steps in a row, each of which ended at a relative gradient of at most 1e-2,
    /// have together gained at most settled_tolerance * |f - base|, unless the last one was a full step along a
    /// definite Hessian, after which the end is near anyway. For long valleys with negligible decrease at their end
    /// (docs/explanation/numerics.md, "Stopping criteria"). Range [0, 1); off here, on by default in maps of surfaces.
    double settled_tolerance = 0;

    /// Stop after two uncapped steps in a row of at most step_tolerance * the longest step of the run.
    /// Range [0, 1); off by default.
    double step_tolerance = 0;

    void validate() const
    {
        if (!(settled_tolerance >= 0 && settled_tolerance < 1))
            throw parameter_error("stopping.settled_tolerance", "must be in [0, 1)");
        if (!(step_tolerance >= 0 && step_tolerance < 1))
            throw parameter_error("stopping.step_tolerance", "must be in [0, 1)");
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
    conjugacy beta = conjugacy::hestenes_stiefel;

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

/// Tuning of minimize().
struct tuning
{
    newton_params newton = {};
    line_tuning line = {};
    lbfgs_params lbfgs = {};
    conjugate_gradient_params conjugate_gradient = {};
    stopping_tuning stopping = {};
    double first_length = 1;       ///< as in descent_params
    double linearize_after = 0.03; ///< as in descent_params
};

} // namespace taut::solve::impl
