// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <span>
#include <string>

#include <taut/impl/core/compute/kernel.hpp>
#include <taut/impl/core/compute/program/vector_program.hpp>
#include <taut/impl/core/core/parallel.hpp>

namespace taut::impl
{

/// Incidence of cell corners to vertices, and the layout of their arrays on the device.
struct gather_layout
{
    int components = 2;            ///< D: numbers per corner contributes
    std::size_t cell_stride = 0;   ///< cells, padded: contributions[(corner * D + c) * cell_stride + cell]
    std::size_t vertex_stride = 0; ///< vertices, padded to a multiple of 64: out[c * vertex_stride + vertex]
};

/// Sums corner contributions into vertices (paper, Fig. 8): out[v] = sum over row v of contributions at (corner, cell).
/// Deterministic, without atomics. Rows are kept in slices of a few vertices, as long as the longest of them (sliced
/// ELLPACK), so that neighbours are summed side by side. Vertices without a row, up to vertex_stride, get zero. Sums
/// are formed in the type of the contributions.
class gather
{
public:
    /// Row v of the incidence is k = offsets[v] .. offsets[v + 1] - 1, with cell cells[k] and corner corners[k].
    /// term: the type of contributions. sum: the type of what is stored of their sums.
    gather(queue& q, std::span<const idx> offsets, std::span<const idx> cells, std::span<const idx> corners,
           const gather_layout& layout, scalar_type term, scalar_type sum);

    /// Enqueues the sums: one launch.
    void operator()(const real_buffer& contributions, real_buffer& out) const;

private:
    /// The largest of the places of all contributions. Throws parameter_error for a cell beyond the stride.
    template <class Place>
    static std::size_t largest_place(std::span<const idx> cells, std::size_t cell_stride, const Place& place)
    {
        std::atomic<std::size_t> largest{0};
        std::atomic<bool> beyond{false};
        const auto is_beyond = [&](idx cell) { return cell < 0 || static_cast<std::size_t>(cell) >= cell_stride; };
        parallel_for(cells.size(),
                     [&](std::size_t begin, std::size_t end)
                     {
                         std::size_t here = 0;
                         bool bad = false;
                         for (std::size_t k = begin; k < end; ++k)
                         {
                             bad |= is_beyond(cells[k]);
                             here = std::max(here, place(k));
                         }
                         if (bad) beyond = true;
                         for (auto known = largest.load(); known < here && !largest.compare_exchange_weak(known, here);)
                             continue;
                     });
        if (!beyond) return largest;
        const idx cell = *std::find_if(cells.begin(), cells.end(), is_beyond);
        throw parameter_error("gather_layout.cell_stride", "cell " + std::to_string(cell) + " is beyond it");
    }

    static idx to_int(std::size_t n);

    scalar_type term_, sum_;
    idx vertices_, cells_;
    std::size_t reach_ = 0; ///< contributions up to the last one that is read
    std::size_t sums_ = 0;
    std::size_t lanes_ = 1; ///< vertices per item
    buffer<idx> starts_, slots_;
    kernel gather_;
};

} // namespace taut::impl
