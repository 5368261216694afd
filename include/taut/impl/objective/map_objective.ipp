// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/objective/map_objective.hpp>

namespace taut::impl
{

template class map_objective<triangle>;

} // namespace taut::impl
