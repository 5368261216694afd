// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <taut/impl/compute/kernel.hpp>
#include <taut/impl/compute/program/vector_program.hpp>
#include <taut/impl/core/parallel.hpp>

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
           const gather_layout& layout, scalar_type term, scalar_type sum)
        : term_(term), sum_(sum), vertices_(to_int(layout.vertex_stride)), cells_(to_int(layout.cell_stride))
    {
        const auto D = static_cast<std::size_t>(layout.components);
        const std::size_t rows = offsets.empty() ? 0 : offsets.size() - 1;
        if (rows > layout.vertex_stride || layout.vertex_stride % 64 != 0)
            throw parameter_error("gather_layout.vertex_stride",
                                  "a multiple of 64, at least the number of rows, is needed");
        const auto place = [&](std::size_t k)
        { return static_cast<std::size_t>(corners[k]) * D * layout.cell_stride + static_cast<std::size_t>(cells[k]); };
        if (!cells.empty())
        {
            const std::size_t last = largest_place(cells, layout.cell_stride, place);
            to_int(last); // the kernel computes in int
            reach_ = last + (D - 1) * layout.cell_stride + 1;
        }

        sums_ = D * layout.vertex_stride;

        // As kernels/gather.cl has them.
        const auto plan = reduction_plan::for_device(q.device());
        lanes_ = plan.width;
        const std::size_t slice = lanes_ == 1 ? 32 : lanes_;
        std::vector<idx> starts{0};
        std::size_t end = 0;
        for (std::size_t v = 0; v < layout.vertex_stride; v += slice)
        {
            idx longest = 0;
            for (std::size_t r = v; r < std::min(v + slice, rows); ++r)
                longest = std::max(longest, offsets[r + 1] - offsets[r]);
            end += static_cast<std::size_t>(longest) * slice;
            starts.push_back(to_int(end));
        }
        std::vector<idx> slots(end, -1);
        parallel_for(rows,
                     [&](std::size_t begin, std::size_t last)
                     {
                         for (std::size_t v = begin; v < last; ++v)
                         {
                             auto to = static_cast<std::size_t>(starts[v / slice]) + v % slice;
                             for (auto k = static_cast<std::size_t>(offsets[v]);
                                  k < static_cast<std::size_t>(offsets[v + 1]); ++k, to += slice)
                                 slots[to] = static_cast<idx>(place(k));
                         }
                     });
        starts_ = buffer<idx>(q, starts);
        slots_ = buffer<idx>(q, slots);
        gather_ = {q, impl::vector_program(), "gather_" + std::string(spelling(term)) + "_" + std::to_string(D),
                   impl::vector_options(sum, q.device(), plan), sum};
    }

    /// Enqueues the sums: one launch.
    void operator()(const real_buffer& contributions, real_buffer& out) const
    {
        if (contributions.type() != term_ || out.type() != sum_)
            throw parameter_error("gather", "buffers of the types that it was made for are needed");
        if (contributions.size() < reach_ || out.size() < sums_)
            throw parameter_error("gather", "buffers of " + std::to_string(reach_) + " contributions and " +
                                                std::to_string(sums_) + " sums are needed");
        if (reach_ == 0) return out.fill(0);
        gather_({static_cast<std::size_t>(vertices_) / lanes_, 64 / lanes_}, vertices_, cells_, starts_, slots_,
                contributions, out);
    }

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

    static idx to_int(std::size_t n)
    {
        if (n > static_cast<std::size_t>(std::numeric_limits<idx>::max()))
            throw size_error("gather", "more than 2^31 contributions");
        return static_cast<idx>(n);
    }

    scalar_type term_, sum_;
    idx vertices_, cells_;
    std::size_t reach_ = 0; ///< contributions up to the last one that is read
    std::size_t sums_ = 0;
    std::size_t lanes_ = 1; ///< vertices per item
    buffer<idx> starts_, slots_;
    kernel gather_;
};

} // namespace taut::impl
