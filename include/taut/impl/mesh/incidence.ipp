// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/mesh/incidence.hpp>

namespace taut::impl
{

template csr vertex_corners(const mesh<triangle>&);
template csr vertex_neighbours(const mesh<triangle>&);
template csr vertex_corners(const mesh<tetrahedron>&);
template csr vertex_neighbours(const mesh<tetrahedron>&);

} // namespace taut::impl
