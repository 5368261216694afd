// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include <taut/impl/core/core/csr.hpp>
#include <taut/impl/core/sparse/block_pattern.hpp>

namespace taut::impl
{

/// Corners of a cell of a range of std::array<idx, K>.
template <class Cells>
inline constexpr std::size_t cell_corners =
    std::tuple_size_v<std::remove_cvref_t<decltype(std::declval<const Cells&>()[0])>>;

/// The corners that meet in each vertex: K * cell + corner, ascending. cells: arrays of corner numbers below `rows`.
/// Throws parameter_error.
template <class Cells>
csr incidence_of_cells(const Cells& cells, std::size_t rows)
{
    constexpr std::size_t K = cell_corners<Cells>;
    if (cells.size() > static_cast<std::size_t>(std::numeric_limits<idx>::max()) / K)
        throw size_error("cells", "more than 2^31 corners");
    csr around;
    around.offsets.assign(rows + 1, 0);
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (const idx v : cells[c])
        {
            if (v < 0 || static_cast<std::size_t>(v) >= rows)
                throw parameter_error("cells", "cell " + std::to_string(c) + " has a corner out of range");
            ++around.offsets[static_cast<std::size_t>(v)];
        }
    // Running ends, which filling from the back turns into starts.
    for (std::size_t v = 0, end = 0; v <= rows; ++v)
        around.offsets[v] = static_cast<idx>(end += static_cast<std::size_t>(around.offsets[v]));
    around.items.resize(K * cells.size());
    for (std::size_t c = cells.size(); c-- > 0;)
        for (std::size_t k = K; k-- > 0;)
            around.items[static_cast<std::size_t>(--around.offsets[static_cast<std::size_t>(cells[c][k])])] =
                static_cast<idx>(K * c + k);
    return around;
}

/// The pattern of a matrix that is a sum of element matrices, for a device with so many rows per slice.
template <class Cells>
block_pattern pattern_of_cells(const Cells& cells, const csr& around, idx slice)
{
    constexpr std::size_t K = cell_corners<Cells>;
    const auto make_row = [&]
    {
        return [&](std::size_t v, std::vector<idx>& others)
        {
            const auto start = static_cast<std::ptrdiff_t>(others.size());
            const auto corners = around.row(static_cast<idx>(v));
            const bool few = corners.size() * (K - 1) <= impl::short_list::most;
            impl::short_list seen; // searching beats sorting
            seen.clear();
            for (const idx corner : corners)
                for (const idx w : cells[static_cast<std::size_t>(corner) / K])
                {
                    if (w == static_cast<idx>(v)) continue;
                    if (few && seen.find(w) >= 0) continue;
                    if (few) seen.add(w);
                    others.push_back(w);
                }
            if (few) return;
            std::sort(others.begin() + start, others.end());
            others.erase(std::unique(others.begin() + start, others.end()), others.end());
        };
    };
    return impl::make_pattern(static_cast<std::size_t>(around.rows()), slice, make_row);
}
template <class Cells>
block_pattern pattern_of_cells(const Cells& cells, std::size_t rows, idx slice)
{
    return pattern_of_cells(cells, incidence_of_cells(cells, rows), slice);
}

// Compiled once, with the bodies.
extern template csr incidence_of_cells(const std::vector<std::array<idx, 3>>&, std::size_t);
extern template block_pattern pattern_of_cells(const std::vector<std::array<idx, 3>>&, const csr&, idx);
extern template csr incidence_of_cells(const std::vector<std::array<idx, 4>>&, std::size_t);
extern template block_pattern pattern_of_cells(const std::vector<std::array<idx, 4>>&, const csr&, idx);

} // namespace taut::impl
