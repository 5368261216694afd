// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include <taut/impl/core/objective/device_solvers.hpp>
#include <taut/impl/core/objective/element_hessian.hpp>
#include <taut/impl/core/objective/element_kernels.hpp>
#include <taut/impl/core/objective/fixed_terms.hpp>
#include <taut/impl/core/objective/map_objective.hpp>
#include <taut/impl/core/objective/mesh_levels.hpp>
#include <taut/impl/core/objective/minimizers.hpp>
#include <taut/impl/core/objective/newton_objective.hpp>
#include <taut/impl/core/objective/newton_plan.hpp>
#include <taut/impl/core/objective/spring_terms.hpp>
#include <taut/impl/core/objective/traced_element.hpp>
#include <taut/impl/core/objective/vertex_relaxation.hpp>

namespace taut::solve::impl
{

template class pcg<const device_vectors>;
template class pair_memory<const device_vectors>;
template class gram_inverse_hessian<const device_vectors>;
template search_result search(any_line&, double, const line_search_params&, bool);

} // namespace taut::solve::impl

namespace taut::impl
{

template struct element_arrays<triangle>;
template struct element_hessian_kernel<triangle>;
template struct element_kernels<triangle>;
template class fixed_terms<triangle>;
template class map_objective<triangle>;
template class mesh_levels<triangle>;

} // namespace taut::impl

namespace taut::solve
{

template report minimize(taut::impl::newton_objective<triangle>&, taut::impl::newton_objective<triangle>::point&,
                         const params&, const run_limits&);
template class impl::prescribed_newton<taut::impl::newton_objective<triangle>>;

} // namespace taut::solve

namespace taut::impl
{

template struct newton_kernels<triangle>;
template class newton_objective<triangle>;
template struct newton_plan<triangle>;
template class spring_terms<triangle>;

element_inputs::element_inputs(recording& r, const real_types& types, const any_energy& energy)
    : corners(r.in<idx>("corners")),
      inverse(r.in<double>("inverse", types.vector)),
      measure(r.in<double>("measure", types.vector)),
      weight(r.in<double>("weight", types.vector)),
      x(r.in<double>("x", types.position)),
      cell_stride(r.scalar<idx>("cell_stride")),
      vertex_stride(r.scalar<idx>("vertex_stride")),
      attribute_count(static_cast<int>(energy.attributes().size()))
{
    if (attribute_count > 0) attributes.emplace(r.in<double>("attributes", types.vector));
    if (energy.directions()) frames.emplace(r.in<double>("frames", types.vector));
    for (std::size_t k = 0; k < energy.parameters().size(); ++k)
        parameters.push_back(r.scalar<double>("parameter" + std::to_string(k), types.vector));
}

template class traced_element<2>;
template struct relaxation_kernels<triangle>;
template class vertex_relaxation<triangle>;

} // namespace taut::impl
