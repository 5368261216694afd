// SPDX-License-Identifier: MIT
#pragma once

#include <taut/solve/conjugate_gradient.hpp>
#include <taut/solve/gradient_descent.hpp>
#include <taut/solve/host_objective.hpp>
#include <taut/solve/lbfgs.hpp>
#include <taut/solve/newton.hpp>

namespace taut::solve
{

enum class method
{
    automatic,          ///< newton where the objective has a Hessian, else lbfgs
    newton,             ///< truncated Newton: objectives with a Hessian only
    lbfgs,              ///< limited-memory BFGS, preconditioned where the objective can
    conjugate_gradient, ///< the paper's preconditioned nonlinear conjugate gradient
    gradient_descent    ///< steepest descent, for comparison
};

/// Everything that can be set, by algorithm. Nested aggregates with defaults:
///
///     minimize(f, x, {.method = method::conjugate_gradient, .stopping = {.gradient_tolerance = 1e-8}});
struct params
{
    solve::method method = solve::method::automatic;
    newton_params newton = {};
    lbfgs_params lbfgs = {};
    conjugate_gradient_params conjugate_gradient = {};
    line_search_params line_search = {};
    stopping_params stopping = {};

    /// As in descent_params.
    double first_length = 1;

    /// Throws parameter_error that names the field.
    void validate() const
    {
        newton.validate();
        lbfgs.validate();
        conjugate_gradient.validate();
        common().validate();
    }

    descent_params common() const
    {
        return {.line_search = line_search, .stopping = stopping, .first_length = first_length};
    }
};

/// Minimises f from x. x becomes the best iterate, whatever the reason to stop, which the report names; the values
/// in its history fall monotonically. Throws parameter_error, and what f and the observer throw: x is then the last
/// iterate.
template <objective Objective>
report minimize(Objective& f, typename Objective::point& x, const params& p = {}, const observer& ask = {})
{
    p.validate();
    switch (p.method)
    {
    case method::automatic:
    case method::newton:
        if constexpr (has_hessian<Objective>) return newton(f, x, p.newton, p.common(), ask);
        if (p.method == method::newton) throw parameter_error("method", "newton needs an objective with a Hessian");
        break;
    case method::conjugate_gradient:
        return conjugate_gradient(f, x, p.conjugate_gradient, p.common(), ask);
    case method::gradient_descent:
        return gradient_descent(f, x, p.common(), ask);
    case method::lbfgs:
        break;
    }
    return lbfgs(f, x, p.lbfgs, p.common(), ask);
}

} // namespace taut::solve
