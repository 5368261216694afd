// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/mesh/layout.hpp>

namespace taut::impl
{

template struct layout<triangle>;
template struct layout<tetrahedron>;

} // namespace taut::impl
