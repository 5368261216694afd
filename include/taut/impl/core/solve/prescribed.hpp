// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include <taut/impl/core/solve/full_objective.hpp>
#include <taut/impl/core/solve/pcg.hpp>
#include <taut/solve_params.hpp>

namespace taut::solve::impl
{

/// Parameters of incremental loading: how prescribed coordinates are brought to their values.
struct prescribed_params
{
    /// Conjugate gradients of the steps of free coordinates: the system is dominated by the neighbours of the moving
    /// ones, so that a small gain does not mean that those farther off have followed.
    pcg_params pcg = {.gain = 0.01};

    /// As in line_tuning.
    double barrier_fraction = 0.9;

    /// Maximum relative increase of f per step, relative to its scale where that is larger (`value_scale()` in
    /// objective.hpp): after a steep increase the free coordinates are far from their equilibrium. Range > 0.
    double most_rise = 0.25;

    /// Maximum relative increase of f over a run, times the closed fraction of the gap: beyond that the run has
    /// stalled, where f grows without bound and the coordinates come no nearer. Range > 0.
    double most_cost = 10;

    /// Step length below which the objective relaxes the elements that cut the step. Range [0, 1].
    double relax_below = 0.5;

    /// Throws parameter_error that names the field.
    void validate() const
    {
        pcg.validate();
        if (!(barrier_fraction > 0 && barrier_fraction < 1))
            throw parameter_error("prescribed.barrier_fraction", "must be in (0, 1)");
        if (!(most_rise > 0)) throw parameter_error("prescribed.most_rise", "must be positive");
        if (!(most_cost > 0)) throw parameter_error("prescribed.most_cost", "must be positive");
        if (!(relax_below >= 0 && relax_below <= 1))
            throw parameter_error("prescribed.relax_below", "must be in [0, 1]");
    }
};

/// Report of incremental loading.
struct prescribed_report
{
    bool arrived = false;   ///< they have their values
    bool crawling = false;  ///< the last steps, of this run and those before, have hardly changed anything
    double left = 0;        ///< remaining fraction of the gap
    double value_start = 0; ///< f at the start
    double value = 0;       ///< f at the last trial step that was taken
    int iterations = 0;     ///< steps, those included that were not taken
    int products = 0;       ///< Hessian products
};

/// Brings coordinates of a point to prescribed values, within the domain of f, while the others follow: Newton's method
/// with prescribed displacements (Dirichlet increments),
///
///     K_ff d_f = -g_f - K_fp d_p,    x <- x + a (d_f, d_p),
///
/// d_p towards the values, but at most as long as a radius that grows after full steps and shrinks after short ones,
/// and 0 where the step before was short, until f falls no more.
/// The length a is the best of four under min(1, a fraction of the first flip), or of ever shorter ones where none of
/// these will do, by the merit function f + nu |what is
/// missing| of sequential quadratic programming (Nocedal & Wright, 18.27), whose nu is such that the step may cost
/// twice what the model expects (18.33, with rho = 1/2). It keeps its vectors and the radius from run to run.
template <class Objective>
    requires has_prescribed<Objective>
class prescribed_newton
{
public:
    using point = typename Objective::point;
    using vector = vector_of<Objective>;

    /// Refers to the objective.
    explicit prescribed_newton(Objective& f, const prescribed_params& params = {})
        : prescribed_(f),
          f_(f),
          params_(params),
          pcg_(f_.space(), params.pcg),
          next_(f_.make_point()),
          d_(f_.space().make()),
          g_(f_.space().make()),
          follow_(f_.space().make())
    {
        params.validate();
    }

    /// x: in the domain; moved. gap: the norm of the remaining displacement, > 0. proceed() is asked before each step
    /// but the first.
    prescribed_report run(point& x, double gap, const std::function<bool(const prescribed_report&)>& proceed);

private:
    static constexpr int patience = 8;         // steps
    static constexpr int rounds = 3;           // of four trial steps each, until one will do
    static constexpr double centring = 1e-2;   // part of f that a step must gain for another one
    static constexpr double least_cost = 1e-3; // part of f that is always worth a step

    struct progress
    {
        double moved = 0, fallen = 0; ///< by how much the gap has become shorter, and f
    };

    progress step(point& x, prescribed_report& r);

    /// Maximum f for a remaining fraction of the gap.
    double costliest(double left) const { return *start_ + params_.most_cost * (1 - left / gap_) * f_.size(*start_); }

    struct trial
    {
        double step, value;
    };

    /// Trial step of minimum merit, 0 if none is below that of the point itself. rise: increase predicted by the model
    /// for the full step.
    trial longest(const point& x, double value, double rise, double share, double left);

    Objective& prescribed_;
    full_objective<Objective> f_;
    prescribed_params params_;
    solve::impl::pcg<space_of<Objective>> pcg_;
    point next_;
    vector d_, g_, follow_;                                   // d; the gradient that the others see; d of the others
    double radius_ = std::numeric_limits<double>::infinity(); // of d at what is prescribed
    double gap_ = 0;                                          // at the start of the run
    std::optional<double> start_;                             // f there
    bool centring_ = false; // the next step leaves the prescribed coordinates where they are
    int slow_ = 0;          // steps in a row that brought little
};

// Apart, so that what is instantiated once is compiled once.

template <class Objective>
    requires has_prescribed<Objective> prescribed_report prescribed_newton<Objective>::run(
        point& x, double gap, const std::function<bool(const prescribed_report&)>& proceed)
    {
        prescribed_report r{.left = gap};
        gap_ = gap;
        start_.reset();
        radius_ = std::max(radius_, 0.05 * gap); // a new way is another try
        do {
            const auto [moved, fallen] = step(x, r);
            const bool useful = moved > 0.02 * r.left || fallen > 1e-3 * f_.size(r.value);
            slow_ = useful ? 0 : slow_ + 1;
            r.left = r.arrived ? 0 : r.left - moved;
            r.crawling = slow_ >= patience;
        } while (!r.arrived && !r.crawling && proceed(r));
        if (r.crawling) slow_ = 0;
        r.value_start = *start_;
        return r;
    }

template <class Objective>
    requires has_prescribed<Objective>
typename prescribed_newton<Objective>::progress prescribed_newton<Objective>::step(point& x, prescribed_report& r)
{
    const double share = centring_ ? 0 : std::min(1.0, radius_ / r.left), length = share * r.left;
    const auto here = prescribed_.linearize_towards(x, share, d_, g_);
    if (!start_) start_ = here.value;
    const auto model = pcg_.solve(
        g_, [this](const vector& v, vector& out) { f_.hessian_product(v, out); },
        [this](const vector& v, vector& out) { f_.precondition(v, out); }, follow_);
    f_.space().axpby(1, follow_, 1, d_);
    ++r.iterations;
    r.products += model.steps;
    // A motion that costs nothing in the model, as a turn, costs a little in a straight line.
    const double least_rise = centring_ ? 0 : least_cost * f_.size(here.value);
    const auto [taken, value] =
        longest(x, here.value, std::max(least_rise, here.change - model.decrease), share, r.left);
    r.value = value;
    if (!centring_) radius_ = taken == 1 ? std::max(radius_, 2 * length) : length * std::max(taken, 0.25);
    const double fallen = here.value - value;
    centring_ = centring_ ? fallen > centring * f_.size(value) : taken < params_.relax_below;
    if (taken > 0)
    {
        f_.step(x, taken, d_, next_);
        std::swap(x, next_);
    }
    r.arrived = taken == 1 && share == 1;
    if (r.arrived) prescribed_.put(x);
    if (taken < params_.relax_below) f_.relax(x);
    return {taken * length, fallen};
}

template <class Objective>
    requires has_prescribed<Objective>
typename prescribed_newton<Objective>::trial
prescribed_newton<Objective>::longest(const point& x, double value, double rise, double share, double left)
{
    const double noise = f_.rounding() * f_.size(value);
    const double steepest = value + params_.most_rise * f_.size(value);
    trial best{0, value};
    double least = value + noise, unit = 1;
    std::array<double, 4> a{1, 0.5, 0.25, 0.125}, values;
    for (int round = 0; round < rounds && best.step == 0; ++round)
    {
        if (round == 0)
            unit = f_.capped_values(x, d_, params_.barrier_fraction, a, values);
        else
        {
            for (double& shorter : a) shorter *= (round == 1 ? unit : 1) / 16;
            unit = 1;
            f_.values(x, d_, a, values);
        }
        for (std::size_t i = 0; i < a.size(); ++i)
        {
            const double merit = values[i] - 2 * rise * unit * a[i];
            if (!(merit < least) || values[i] > std::min(steepest, costliest(left * (1 - share * unit * a[i]))))
                continue;
            least = merit;
            best = {unit * a[i], values[i]};
        }
    }
    return best;
}

} // namespace taut::solve::impl
