// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/map/session/incremental_loading.hpp>

namespace taut::impl
{

template class incremental_loading<triangle>;

} // namespace taut::impl
