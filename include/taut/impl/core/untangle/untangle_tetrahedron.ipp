// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/untangle/untangle_on_device.ipp>
#include <taut/impl/core/untangle/untangle_refined.ipp>

namespace taut
{

untangle_result<tetrahedron> untangle(const untangle_problem<tetrahedron>& problem, const untangle_params& params,
                                      const run_limits& limits)
{
    return untangle(problem, impl::solid_host_stages(), impl::newton_maker<tetrahedron>(), params, limits);
}

template untangle_result<tetrahedron> impl::untangle(const untangle_problem<tetrahedron>&,
                                                     impl::untangle_stages<tetrahedron>,
                                                     impl::newton_maker<tetrahedron>, const untangle_params&,
                                                     const run_limits&);
template untangle_result<tetrahedron> untangle(const queue&, const untangle_problem<tetrahedron>&,
                                               const untangle_params&, const run_limits&);
template refined_untangling<tetrahedron> untangle(const queue&, const untangle_problem<tetrahedron>&,
                                                  const untangle_params&, const run_limits&, const refine_params&);

} // namespace taut
