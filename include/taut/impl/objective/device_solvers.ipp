// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/objective/device_solvers.hpp>

namespace taut::solve::impl
{

template class pcg<const device_vectors>;
template class pair_memory<const device_vectors>;
template class gram_inverse_hessian<const device_vectors>;
template search_result search(any_line&, double, const line_search_params&, bool);

} // namespace taut::solve::impl
