// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <taut/compute/detail/vector_program.hpp>
#include <taut/compute/kernel.hpp>
#include <taut/core/parallel.hpp>

namespace taut
{

/// Which corners of which cells meet at each vertex, and how their arrays lie on the device.
struct gather_layout
{
    int components = 2;            ///< D: numbers a corner contributes
    std::size_t cell_stride = 0;   ///< cells, padded: contributions[(corner * D + c) * cell_stride + cell]
    std::size_t vertex_stride = 0; ///< vertices, padded to a multiple of 64: out[c * vertex_stride + vertex]
};

/// Sums corner contributions into vertices (paper, Fig. 8): out[v] = sum over row v of contributions at (corner, cell).
/// Deterministic, without atomics. The first slots of all vertices are kept in columns (ELLPACK), which vectorises; the
/// few vertices of high valence have a second, short launch for the rest of their rows. Vertices without a row, up to
/// vertex_stride, get zero. Sums are formed in the type of the contributions.
class gather
{
public:
    /// Row v of the incidence is k = offsets[v] .. offsets[v + 1] - 1, with cell cells[k] and corner corners[k].
    /// term: the type of contributions. sum: the type of what is stored of their sums.
    gather(queue& q, std::span<const idx> offsets, std::span<const idx> cells, std::span<const idx> corners,
           const gather_layout& layout, scalar_type term, scalar_type sum)
        : term_(term),
          sum_(sum),
          components_(layout.components),
          vertices_(to_int(layout.vertex_stride)),
          cells_(to_int(layout.cell_stride))
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

        const auto valence = [&](std::size_t v) { return static_cast<std::size_t>(offsets[v + 1] - offsets[v]); };
        width_ = common_width(rows, valence);
        to_int(width_ * layout.vertex_stride);
        sums_ = D * layout.vertex_stride;

        std::vector<idx> columns(width_ * layout.vertex_stride, -1), which, rest_offsets{0}, rest;
        parallel_for(rows,
                     [&](std::size_t begin, std::size_t end)
                     {
                         for (std::size_t v = begin; v < end; ++v)
                         {
                             const auto first = static_cast<std::size_t>(offsets[v]);
                             for (std::size_t j = 0; j < std::min(width_, valence(v)); ++j)
                                 columns[j * layout.vertex_stride + v] = static_cast<idx>(place(first + j));
                         }
                     });
        for (std::size_t v = 0; v < rows; ++v)
        {
            if (valence(v) <= width_) continue;
            for (auto k = static_cast<std::size_t>(offsets[v]) + width_; k < static_cast<std::size_t>(offsets[v + 1]);
                 ++k)
                rest.push_back(static_cast<idx>(place(k)));
            which.push_back(static_cast<idx>(v));
            rest_offsets.push_back(static_cast<idx>(rest.size()));
        }
        columns_ = buffer<idx>(q, columns);
        rest_rows_ = to_int(which.size());
        which_ = buffer<idx>(q, which);
        rest_offsets_ = buffer<idx>(q, rest_offsets);
        rest_ = buffer<idx>(q, rest);

        const std::string type(spelling(term));
        const auto options = detail::vector_options(sum, q.device(), reduction_plan::for_device(q.device()));
        gather_ = {q, detail::vector_program(),
                   "gather_" + type + "_" + std::to_string(D) + 'x' + std::to_string(width_), options, sum};
        if (rest_rows_) gather_rest_ = {q, detail::vector_program(), "gather_rest_" + type, options, sum};
    }

    /// Enqueues the sums: one launch, or two with vertices of high valence.
    void operator()(const real_buffer& contributions, real_buffer& out) const
    {
        if (contributions.type() != term_ || out.type() != sum_)
            throw parameter_error("gather", "buffers of the types that it was made for are needed");
        if (contributions.size() < reach_ || out.size() < sums_)
            throw parameter_error("gather", "buffers of " + std::to_string(reach_) + " contributions and " +
                                                std::to_string(sums_) + " sums are needed");
        if (reach_ == 0) return out.fill(0);
        gather_({static_cast<std::size_t>(vertices_), 64}, vertices_, cells_, columns_, contributions, out);
        if (rest_rows_)
            gather_rest_({padded(static_cast<std::size_t>(rest_rows_), 64), 64}, components_, vertices_, cells_,
                         rest_rows_, which_, rest_offsets_, rest_, contributions, out);
    }

    /// Slots a vertex in the first launch, and vertices that need the second.
    std::size_t width() const noexcept { return width_; }
    std::size_t overfull() const noexcept { return static_cast<std::size_t>(rest_rows_); }

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

    /// The width of least cost, of those that kernels/gather.cl has. By measurement on PoCL, in units of a slot of the
    /// first launch, a vertex in the second launch costs about 30 and the launch itself 10,000.
    template <class Valence>
    static std::size_t common_width(std::size_t rows, const Valence& valence)
    {
        constexpr std::array<std::size_t, 9> widths = {48, 32, 24, 16, 12, 10, 8, 6, 4};
        constexpr std::size_t widest = widths.front();
        std::vector<std::size_t> count(widest + 2, 0); // of rows by length; the last entry: all longer ones
        for (std::size_t v = 0; v < rows; ++v) ++count[std::min(valence(v), widest + 1)];
        std::size_t best = widest, beyond = 0, length = widest + 1, least = std::numeric_limits<std::size_t>::max();
        for (const std::size_t width : widths)
        {
            for (; length > width; --length) beyond += count[length];
            const std::size_t cost = width * rows + (beyond ? 10000 + 30 * beyond : 0);
            if (cost > least) continue;
            best = width;
            least = cost;
        }
        return best;
    }

    static idx to_int(std::size_t n)
    {
        if (n > static_cast<std::size_t>(std::numeric_limits<idx>::max()))
            throw size_error("gather", "more than 2^31 contributions");
        return static_cast<idx>(n);
    }

    scalar_type term_, sum_;
    idx components_, vertices_, cells_, rest_rows_ = 0;
    std::size_t reach_ = 0; ///< contributions up to the last one that is read
    std::size_t sums_ = 0;
    std::size_t width_ = 4;
    buffer<idx> columns_, which_, rest_offsets_, rest_;
    kernel gather_, gather_rest_;
};

} // namespace taut
