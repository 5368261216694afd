// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/objective/spring_terms.hpp>

namespace taut::impl
{

template class spring_terms<triangle>;

} // namespace taut::impl
