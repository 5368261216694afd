// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/objective/vertex_relaxation.hpp>

namespace taut::impl
{

template struct relaxation_kernels<triangle>;
template class vertex_relaxation<triangle>;

} // namespace taut::impl
