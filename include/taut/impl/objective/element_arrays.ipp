// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/objective/element_arrays.hpp>

namespace taut::impl
{

template struct element_arrays<triangle>;

} // namespace taut::impl
