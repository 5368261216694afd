// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/mesh/mesh.hpp>

namespace taut
{

template class mesh<triangle>;
template class mesh<tetrahedron>;

} // namespace taut
