// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/solve/line/line_function.hpp>
#include <taut/solve_params.hpp>

#include <cmath>

namespace taut::solve::impl
{

/// The conditions along one line.
///
/// | here          | source                                                                                       |
/// |---------------|----------------------------------------------------------------------------------------------|
/// | `armijo`      | (3.7a): phi(a) <= phi(0) + c1 a phi'(0)                                                       |
/// | `curvature`   | (3.7b): abs phi'(a) <= c2 abs phi'(0)                                                         |
/// | `approximate` | Hager & Zhang 2005, (2.2), "approximate Wolfe": (2 c1 - 1) phi'(0) >= phi'(a) >= c2 phi'(0)    |
///
/// The last one says the same as the first two for a quadratic, but in slopes, which keep their digits where the
/// decrease of the value is lost in rounding. It is trusted only there: where phi(a) is phi(0) to a hundred
/// roundings, and at most one above the lowest value so far.
class wolfe_conditions
{
public:
    template <line_function Line>
    wolfe_conditions(const Line& phi, const wolfe_params& p)
        : start_(phi.start()),
          ceiling_(phi.ceiling()),
          blur_(blur * phi.noise()),
          c1_(p.sufficient_decrease),
          c2_(p.curvature)
    {
    }

    bool armijo(double step, double value) const
    {
        const double promised = c1_ * step * start_.slope;
        return value <= start_.value + promised && value < start_.value; // the sum may round to phi(0)
    }

    bool curvature(double slope) const { return std::abs(slope) <= c2_ * std::abs(start_.slope); }

    bool approximate(double value, double slope) const
    {
        return value <= ceiling_ && value >= start_.value - blur_ && slope <= (2 * c1_ - 1) * start_.slope &&
               slope >= c2_ * start_.slope;
    }

    bool accept(const line_point& at) const
    {
        return (armijo(at.step, at.value) && curvature(at.slope)) || approximate(at.value, at.slope);
    }

    /// Returns whether the value cannot judge a step of this length: all it could change is within rounding.
    bool blind(double step) const { return step * std::abs(start_.slope) <= blur_; }

private:
    static constexpr double blur = 100; // in roundings of a value

    line_point start_;
    double ceiling_, blur_, c1_, c2_;
};

} // namespace taut::solve::impl
