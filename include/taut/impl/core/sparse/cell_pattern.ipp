// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <taut/impl/core/sparse/assembly_lists.hpp>
#include <taut/impl/core/sparse/cell_pattern.hpp>

namespace taut::impl
{

template csr incidence_of_cells(const std::vector<std::array<idx, 3>>&, std::size_t);
template block_pattern pattern_of_cells(const std::vector<std::array<idx, 3>>&, const csr&, idx);
template csr incidence_of_cells(const std::vector<std::array<idx, 4>>&, std::size_t);
template block_pattern pattern_of_cells(const std::vector<std::array<idx, 4>>&, const csr&, idx);
template assembly_lists::assembly_lists(const block_pattern&, int, const std::vector<std::array<idx, 3>>&, const csr&,
                                        std::size_t, std::span<const char>);
template assembly_lists::assembly_lists(const block_pattern&, int, const std::vector<std::array<idx, 4>>&, const csr&,
                                        std::size_t, std::span<const char>);

} // namespace taut::impl
