// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/objective/newton_objective.hpp>

namespace taut::impl
{

template class traced_element<2>;
template class fixed_terms<triangle>;
template class spring_terms<triangle>;
template struct element_kernels<triangle>;
template struct element_hessian_kernel<triangle>;
template struct relaxation_kernels<triangle>;
template struct element_arrays<triangle>;
template class map_objective<triangle>;
template struct newton_kernels<triangle>;
template class newton_objective<triangle>;

} // namespace taut::impl
