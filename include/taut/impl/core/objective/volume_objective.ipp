// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/objective/volume_objective.hpp>

namespace taut::impl
{

template class traced_element<3>;
template class fixed_terms<tetrahedron>;
template class spring_terms<tetrahedron>;
template struct element_kernels<tetrahedron>;
template struct element_hessian_kernel<tetrahedron>;
template struct relaxation_kernels<tetrahedron>;
template class vertex_relaxation<tetrahedron>;
template class mesh_levels<tetrahedron>;
template struct newton_plan<tetrahedron>;
template struct element_arrays<tetrahedron>;
template class map_objective<tetrahedron>;
template struct newton_kernels<tetrahedron>;
template class newton_objective<tetrahedron>;

} // namespace taut::impl

namespace taut::solve
{

template report minimize(taut::impl::newton_objective<tetrahedron>&, taut::impl::newton_objective<tetrahedron>::point&,
                         const params&, const run_limits&);
template class impl::prescribed_newton<taut::impl::newton_objective<tetrahedron>>;

} // namespace taut::solve
