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
        if constexpr (impl::has_hessian<Objective>)
        {
            p.require_newton_search();
            return newton(f, x, p.tuning.newton, p.common(), ask);
        }
        if (p.method == method::newton) throw parameter_error("method", "newton needs an objective with a Hessian");
        break;
    case method::conjugate_gradient:
        return impl::conjugate_gradient(f, x, p.conjugate_gradient, p.common(), ask);
    case method::gradient_descent:
        return impl::gradient_descent(f, x, p.common(), ask);
    case method::lbfgs:
        break;
    }
    return impl::lbfgs(f, x, p.lbfgs, p.common(), ask);
}

} // namespace taut::solve
