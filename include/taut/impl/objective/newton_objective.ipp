// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/objective/newton_objective.hpp>

namespace taut::impl
{

template struct newton_kernels<triangle>;
template class newton_objective<triangle>;

} // namespace taut::impl
