// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/objective/newton_plan.hpp>

namespace taut::impl
{

template struct newton_plan<triangle>;

} // namespace taut::impl
