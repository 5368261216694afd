// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/mesh/ideal.hpp>

namespace taut::impl
{

template std::pair<std::vector<idx>, std::vector<idx>> bad_rest_cells(const mesh<triangle>&);
template std::pair<std::vector<idx>, std::vector<idx>> bad_rest_cells(const mesh<tetrahedron>&);
template struct ideal_elements<triangle>;
template struct ideal_elements<tetrahedron>;

} // namespace taut::impl
