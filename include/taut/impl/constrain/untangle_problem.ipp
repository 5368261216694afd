// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/constrain/untangle_problem.hpp>

namespace taut
{

template struct untangle_problem<triangle>;
template struct untangle_problem<tetrahedron>;

} // namespace taut
