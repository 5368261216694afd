// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/sparse/assembly_lists.hpp>

namespace taut::impl
{

template assembly_lists::assembly_lists(const block_pattern&, int, const std::vector<std::array<idx, 3>>&, const csr&,
                                        std::size_t, std::span<const char>);

template assembly_lists::assembly_lists(const block_pattern&, int, const std::vector<std::array<idx, 4>>&, const csr&,
                                        std::size_t, std::span<const char>);

} // namespace taut::impl
