// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/objective/fixed_terms.hpp>

namespace taut::impl
{

template class fixed_terms<triangle>;

} // namespace taut::impl
