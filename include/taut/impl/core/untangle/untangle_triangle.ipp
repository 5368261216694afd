// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/untangle/untangle_on_device.ipp>
#include <taut/impl/core/untangle/untangle_refined.ipp>

namespace taut
{

untangle_result<triangle> untangle(const untangle_problem<triangle>& problem, const untangle_params& params,
                                   const run_limits& limits)
{
    return untangle(problem, impl::host_stages(problem.outline_pinned()),
                    impl::newton_maker<triangle>(impl::direct_newton), params, limits);
}

template untangle_result<triangle> impl::untangle(const untangle_problem<triangle>&, impl::untangle_stages<triangle>,
                                                  impl::newton_maker<triangle>, const untangle_params&,
                                                  const run_limits&);
template untangle_result<triangle> untangle(const queue&, const untangle_problem<triangle>&, const untangle_params&,
                                            const run_limits&);
template refined_untangling<triangle> untangle(const queue&, const untangle_problem<triangle>&, const untangle_params&,
                                               const run_limits&, const refine_params&);

} // namespace taut
