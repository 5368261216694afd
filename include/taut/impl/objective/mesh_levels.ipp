// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/objective/mesh_levels.hpp>

namespace taut::impl
{

template class mesh_levels<triangle>;

} // namespace taut::impl
