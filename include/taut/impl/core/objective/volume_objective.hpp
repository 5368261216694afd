// SPDX-License-Identifier: MIT
#pragma once

/// The objectives of volumes, which programs of surfaces need not compile.
#include <taut/elements.hpp>
#include <taut/impl/core/objective/newton_objective.hpp>
#include <taut/impl/core/solve/prescribed.hpp>
#include <taut/minimize.hpp>

namespace taut::impl
{

// Compiled once, with the bodies.
extern template class traced_element<3>;
extern template class fixed_terms<tetrahedron>;
extern template class spring_terms<tetrahedron>;
extern template struct element_kernels<tetrahedron>;
extern template struct element_hessian_kernel<tetrahedron>;
extern template struct relaxation_kernels<tetrahedron>;
extern template class vertex_relaxation<tetrahedron>;
extern template class mesh_levels<tetrahedron>;
extern template struct newton_plan<tetrahedron>;
extern template struct element_arrays<tetrahedron>;
extern template class map_objective<tetrahedron>;
extern template struct newton_kernels<tetrahedron>;
extern template class newton_objective<tetrahedron>;

} // namespace taut::impl

namespace taut::solve
{

extern template report minimize(taut::impl::newton_objective<tetrahedron>&,
                                taut::impl::newton_objective<tetrahedron>::point&, const params&, const run_limits&);
extern template class impl::prescribed_newton<taut::impl::newton_objective<tetrahedron>>;

} // namespace taut::solve
