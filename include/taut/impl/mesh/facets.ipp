// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/mesh/facets.hpp>

namespace taut::impl
{

template facet_table facets(const mesh<triangle>&);
template facet_table facets(const mesh<tetrahedron>&);

} // namespace taut::impl
