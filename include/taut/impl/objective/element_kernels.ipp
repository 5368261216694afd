// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/objective/element_kernels.hpp>

namespace taut::impl
{

template struct element_kernels<triangle>;

} // namespace taut::impl
