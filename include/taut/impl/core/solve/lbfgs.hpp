// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/solve/descent.hpp>

namespace taut::solve::impl
{

/// Minimises f from x by d = -H_k g_k with the last m pairs in H_k (Nocedal & Wright, Algorithm 7.5). An objective with
/// a preconditioner gives H0, scaled by s'y / y'H0 y; one with a Hessian is linearized at the start, and again as the
/// value falls (descent_params::linearize_after); one with relax() is relaxed where no step can be made. x ends at the
/// best iterate whatever the reason to stop. Throws parameter_error, and exceptions of f and the observer.
///
/// Host waits of an iteration whose full step is accepted: the barrier (if any), the value with its gradient, and one
/// multi_dot: 3.
template <objective Objective>
report lbfgs(Objective& f, typename Objective::point& x, const lbfgs_params& params = {},
             const descent_params& common = {}, const run_limits& limits = {})
{
    params.validate();
    common.validate();
    auto h = impl::inverse_hessian(f, params.memory);
    return impl::descent(f, x, h, impl::no_momentum{}, common, limits).run();
}

} // namespace taut::solve::impl
