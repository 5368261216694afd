// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <taut/types.hpp>

namespace taut::impl
{

/// Rows of varying length: row r is items[offsets[r]] .. items[offsets[r + 1] - 1].
struct csr
{
    std::vector<idx> offsets; ///< rows + 1
    std::vector<idx> items;

    idx rows() const { return static_cast<idx>(offsets.size()) - 1; }
    std::span<const idx> row(idx r) const
    {
        const auto first = static_cast<std::size_t>(offsets[static_cast<std::size_t>(r)]);
        const auto last = static_cast<std::size_t>(offsets[static_cast<std::size_t>(r) + 1]);
        return {items.data() + first, last - first};
    }
};

} // namespace taut::impl
