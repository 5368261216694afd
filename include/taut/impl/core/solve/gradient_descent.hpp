// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/solve/descent.hpp>

namespace taut::solve::impl
{

/// Minimises f from x by steepest descent, d = -gamma g with gamma = s'y / y'y of the last step (Nocedal & Wright,
/// section 3.3); with the objective's preconditioner d = -gamma H0 g. For comparison, and for very good
/// preconditioners. x ends at the best iterate. Throws parameter_error.
template <objective Objective>
report gradient_descent(Objective& f, typename Objective::point& x, const descent_params& common = {},
                        const run_limits& limits = {})
{
    common.validate();
    const memory_params none{.pairs = 0};
    auto h = impl::inverse_hessian(f, none);
    return impl::descent(f, x, h, impl::no_momentum{}, common, limits).run();
}

} // namespace taut::solve::impl
