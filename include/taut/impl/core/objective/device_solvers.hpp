// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/solve/line/line_function.hpp>
#include <taut/impl/core/solve/line/line_search.hpp>

/// The parts of the methods that are the same for all objectives on a device.
#include <taut/impl/core/compute/vector_space.hpp>
#include <taut/impl/core/solve/gram.hpp>
#include <taut/impl/core/solve/line/any_line.hpp>
#include <taut/impl/core/solve/pcg.hpp>

namespace taut::solve::impl
{

// Compiled once, with the bodies.
extern template class pcg<const device_vectors>;
extern template class pair_memory<const device_vectors>;
extern template class gram_inverse_hessian<const device_vectors>;
extern template search_result search(any_line&, double, const line_search_params&, bool);

} // namespace taut::solve::impl
