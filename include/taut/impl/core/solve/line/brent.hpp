// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

namespace taut::solve::impl
{

/// Minimiser found, and its value.
struct brent_result
{
    double x = 0;
    double value = 0;
    int evaluations = 0;
    bool converged = false; ///< the interval is below the tolerance
};

/// Accuracy of a minimisation without derivatives.
struct brent_tolerance
{
    /// Relative to x. Values below the square root of the rounding unit, 1.5e-8, are raised to it: a parabola is flat
    /// to rounding nearer than that.
    double relative = 1.5e-8;

    /// Absolute, for minima at 0.
    double absolute = 1e-12;

    int max_evaluations = 100;
};

/// A local minimum of f in [a, c] without derivatives, from b in (a, c) with f(b) = fb known: parabolas through the
/// three lowest points, golden sections where these do not help. Values of +inf are allowed.
///
/// Source: R. Brent, Algorithms for Minimization without Derivatives, 1973, section 5.8 (the paper's [26]).
///
/// | here            | there                                                                       |
/// |-----------------|-----------------------------------------------------------------------------|
/// | `x, w, v`       | the lowest point, the second lowest, the previous value of w                |
/// | `step, before`  | d and e: the last step, and the one before it                               |
/// | `p / q`         | the step to the minimum of the parabola                                     |
template <class F>
brent_result brent(F&& f, double a, double b, double c, double fb, const brent_tolerance& tolerance)
{
    constexpr double golden = 0.3819660112501051; // (3 - sqrt 5) / 2
    const double relative = std::max(tolerance.relative, 1.5e-8);

    double low = std::min(a, c), high = std::max(a, c);
    double x = b, w = b, v = b, fx = fb, fw = fb, fv = fb;
    double step = 0, before = 0;

    for (int evaluations = 0;; ++evaluations)
    {
        const double middle = (low + high) / 2;
        const double t = relative * std::abs(x) + tolerance.absolute;
        const bool done = std::abs(x - middle) <= 2 * t - (high - low) / 2;
        if (done || evaluations >= tolerance.max_evaluations) return {x, fx, evaluations, done};

        double p = 0, q = 0, bar = 0;
        if (std::abs(before) > t)
        {
            const double r = (x - w) * (fx - fv);
            q = (x - v) * (fx - fw);
            p = (x - v) * q - (x - w) * r;
            q = 2 * (q - r);
            if (q > 0)
                p = -p;
            else
                q = -q;
            bar = before;
            before = step;
        }
        // A parabola is trusted while its steps halve every second time. With an infinite value p is not a number, and
        // all three comparisons fail.
        if (std::abs(p) < std::abs(q * bar / 2) && p > q * (low - x) && p < q * (high - x))
        {
            step = p / q;
            if (x + step - low < 2 * t || high - (x + step) < 2 * t) step = x < middle ? t : -t;
        }
        else
        {
            before = x < middle ? high - x : low - x;
            step = golden * before;
        }

        const double u = x + (std::abs(step) >= t ? step : std::copysign(t, step));
        const double fu = f(u);
        if (fu <= fx)
        {
            (u < x ? high : low) = x;
            v = w, fv = fw;
            w = x, fw = fx;
            x = u, fx = fu;
        }
        else
        {
            (u < x ? low : high) = u;
            if (fu <= fw || w == x)
            {
                v = w, fv = fw;
                w = u, fw = fu;
            }
            else if (fu <= fv || v == x || v == w)
                v = u, fv = fu;
        }
    }
}

} // namespace taut::solve::impl
