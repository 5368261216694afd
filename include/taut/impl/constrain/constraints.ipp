// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/constrain/constraints.hpp>

namespace taut
{

template class constraints<triangle>;
template class constraints<tetrahedron>;

} // namespace taut
