// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/solve/conjugate_gradient.hpp>
#include <taut/impl/solve/gradient_descent.hpp>
#include <taut/impl/solve/host_objective.hpp>
#include <taut/impl/solve/lbfgs.hpp>
#include <taut/impl/solve/newton.hpp>

namespace taut::solve
{

/// Minimises f from x. x becomes the best iterate, whatever the reason to stop, which the report names; the values
/// in its history fall monotonically. The current evaluation is finished, whatever the limits. Throws parameter_error,
/// and what f and the observer throw: x is then the last iterate.
template <objective Objective>
report minimize(Objective& f, typename Objective::point& x, const params& p = {}, const run_limits& limits = {})
{
    p.validate();
    limits.validate();
    switch (p.method)
    {
    case method::automatic:
    case method::newton:
        if constexpr (impl::has_hessian<Objective>)
        {
            p.require_newton_search();
            return newton(f, x, p.tuning.newton, p.common(), limits);
        }
        if (p.method == method::newton) throw parameter_error("method", "newton needs an objective with a Hessian");
        break;
    case method::conjugate_gradient:
        return impl::conjugate_gradient(f, x, p.tuning.conjugate_gradient, p.common(), limits);
    case method::gradient_descent:
        return impl::gradient_descent(f, x, p.common(), limits);
    case method::lbfgs:
        break;
    }
    return impl::lbfgs(f, x, p.tuning.lbfgs, p.common(), limits);
}

} // namespace taut::solve
