// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/objective/running_map.hpp>

namespace taut::impl
{

template class running_map<triangle>;

} // namespace taut::impl
