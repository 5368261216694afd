// SPDX-License-Identifier: MIT
#pragma once

/// The parts of the methods that are the same for all objectives on a device.
#include <taut/impl/compute/vector_space.hpp>
#include <taut/impl/solve/gram.hpp>
#include <taut/impl/solve/line/any_line.hpp>
#include <taut/impl/solve/pcg.hpp>

namespace taut::solve::impl
{

// Compiled once, with the bodies.
extern template class pcg<const device_vectors>;
extern template class pair_memory<const device_vectors>;
extern template class gram_inverse_hessian<const device_vectors>;
extern template search_result search(any_line&, double, const line_search_params&, bool);

} // namespace taut::solve::impl

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/objective/device_solvers.ipp>
#endif
