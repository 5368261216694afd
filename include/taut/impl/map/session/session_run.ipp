// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/map/session/session_run.hpp>

namespace taut::impl
{

template class session_run<triangle>;

} // namespace taut::impl
