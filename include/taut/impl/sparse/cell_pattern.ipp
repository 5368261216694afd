// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/sparse/cell_pattern.hpp>

namespace taut::impl
{

template csr incidence_of_cells(const std::vector<std::array<idx, 3>>&, std::size_t);
template block_pattern pattern_of_cells(const std::vector<std::array<idx, 3>>&, const csr&, idx);

template csr incidence_of_cells(const std::vector<std::array<idx, 4>>&, std::size_t);
template block_pattern pattern_of_cells(const std::vector<std::array<idx, 4>>&, const csr&, idx);

} // namespace taut::impl
