// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/objective/element_hessian.hpp>

namespace taut::impl
{

template struct element_hessian_kernel<triangle>;

} // namespace taut::impl
