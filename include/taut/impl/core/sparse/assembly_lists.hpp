// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/core/sparse/cell_pattern.hpp>

namespace taut::impl
{

/// Assembly lists: the entries of element blocks that each place of a block matrix sums, made on the host for
/// block_assembly.
///
/// An element with K corners gives one block for each pair k <= l of its corners, pairs in the order (0,0), (0,1), ..,
/// (0,K-1), (1,1), ..: a block (k, k) has its upper triangle by rows, D (D + 1) / 2 entries, the others all D * D by
/// rows, and row r of the block (k, l) belongs to component r of corner k. The block (l, k) is its transpose. Entry n
/// of all blocks of a cell lies at [n * cell_stride + cell].
class assembly_lists
{
public:
    template <class Cells>
    assembly_lists(const block_pattern& pattern, int block_size, const Cells& cells, std::size_t stride,
                   std::span<const char> fixed = {})
        : assembly_lists(pattern, block_size, cells, incidence_of_cells(cells, pattern.rows()), stride, fixed)
    {
    }

    /// cells: arrays of corner numbers, in the pattern. fixed: a flag per row, or none; rows and columns that are fixed
    /// stay 0, diagonals included. Throws parameter_error.
    template <class Cells>
    assembly_lists(const block_pattern& pattern, int block_size, const Cells& cells, const csr& around,
                   std::size_t stride, std::span<const char> fixed = {});

    std::size_t cell_stride;
    std::size_t places;    ///< of the pattern
    std::size_t reach = 0; ///< entries up to the last one that is read
    /// Entries of the diagonal, and ~entry where the transpose is meant; those of the other nonzeros by their place.
    std::vector<idx> diagonal, others, diagonal_offsets, other_offsets;

private:
    static constexpr idx none = 0x7fffffff;

    /// The lists of slots of the places of one slice of rows.
    class slice_lists
    {
    public:
        explicit slice_lists(std::size_t C) : C_(C) {}
        void begin(std::size_t width)
        {
            counts_.assign(width * C_, 0);
            all_.clear();
        }
        void add(std::size_t j, std::size_t lane, idx slot)
        {
            const std::size_t place = j * C_ + lane;
            all_.push_back({static_cast<idx>(place), counts_[place]++, slot});
        }
        /// Appends them; those of nonzero 0 to `first`.
        void finish(impl::list_chunk& first, impl::list_chunk& rest)
        {
            starts_.clear();
            for (std::size_t p = 0; p < counts_.size(); p += C_)
            {
                auto& list = p == 0 ? first : rest;
                const auto* count = counts_.data() + p;
                const idx size = *std::max_element(count, count + C_) * static_cast<idx>(C_);
                starts_.push_back(list.items.size());
                list.items.resize(list.items.size() + static_cast<std::size_t>(size), none);
                list.sizes.push_back(size);
                if (p == 0) rest.sizes.push_back(0); // its places have a number among all places
            }
            for (const auto& [place, number, slot] : all_)
            {
                const auto p = static_cast<std::size_t>(place);
                auto& items = p < C_ ? first.items : rest.items;
                items[starts_[p / C_] + static_cast<std::size_t>(number) * C_ + p % C_] = slot;
            }
        }

    private:
        struct item
        {
            idx place, number, slot;
        };
        std::size_t C_;
        std::vector<idx> counts_;
        std::vector<item> all_;
        std::vector<std::size_t> starts_;
    };
};

template <class Cells>
assembly_lists::assembly_lists(const block_pattern& pattern, int block_size, const Cells& cells, const csr& around,
                               std::size_t stride, std::span<const char> fixed)
    : cell_stride(stride), places(pattern.columns.size())
{
    constexpr std::size_t K = cell_corners<Cells>;
    const auto D = static_cast<std::size_t>(block_size);
    if (cells.size() > cell_stride) throw parameter_error("cell_stride", "is less than the number of cells");
    if (around.offsets.size() != pattern.rows() + 1) throw parameter_error("around", "is of another mesh");
    if (!fixed.empty() && fixed.size() != pattern.rows())
        throw parameter_error("fixed", "needs one flag a row, or none");
    std::array<std::array<std::size_t, K>, K> first{}; // entry 0 of the block of each pair
    std::size_t entries = 0;
    for (std::size_t k = 0; k < K; ++k)
        for (std::size_t l = k; l < K; ++l)
        {
            first[k][l] = first[l][k] = entries * cell_stride;
            entries += k == l ? D * (D + 1) / 2 : D * D;
        }
    if (entries * cell_stride >= static_cast<std::size_t>(none))
        throw size_error("assembly_lists", "more than 2^31 entries of element blocks");
    if (cells.size() > 0) reach = (entries - 1) * cell_stride + cells.size();

    const auto is_fixed = [&](idx v) { return !fixed.empty() && fixed[static_cast<std::size_t>(v)]; };
    std::vector<impl::list_chunk> own(impl::chunk_count(pattern.rows())), rest(own.size());
    const auto C = static_cast<std::size_t>(pattern.slice);
    const auto make = [&](std::size_t chunk, std::size_t begin, std::size_t end)
    {
        slice_lists lists(C);
        impl::sliced_row row;
        for (std::size_t start = begin; start < end; start += C)
        {
            lists.begin(pattern.width(start));
            for (std::size_t v = start; v < std::min(start + C, end); ++v)
            {
                if (is_fixed(static_cast<idx>(v))) continue;
                row.read(pattern, v);
                for (const idx corner : around.row(static_cast<idx>(v)))
                {
                    const std::size_t cell = static_cast<std::size_t>(corner) / K,
                                      k = static_cast<std::size_t>(corner) % K;
                    lists.add(0, v % C, static_cast<idx>(first[k][k] + cell));
                    for (std::size_t l = 0; l < K; ++l)
                    {
                        const idx w = cells[cell][l];
                        if (l == k || is_fixed(w)) continue;
                        const auto slot = static_cast<idx>(first[k][l] + cell);
                        lists.add(row.find(w), v % C, k < l ? slot : ~slot);
                    }
                }
            }
            lists.finish(own[chunk], rest[chunk]);
        }
    };
    impl::for_each_chunk(pattern.rows(), make);
    diagonal = impl::joined(own);
    others = impl::joined(rest);
    diagonal_offsets = impl::slice_offsets(own, pattern.stride() / C);
    other_offsets = impl::slice_offsets(rest, places / C);
}

// Compiled once, with the bodies.
extern template assembly_lists::assembly_lists(const block_pattern&, int, const std::vector<std::array<idx, 3>>&,
                                               const csr&, std::size_t, std::span<const char>);
extern template assembly_lists::assembly_lists(const block_pattern&, int, const std::vector<std::array<idx, 4>>&,
                                               const csr&, std::size_t, std::span<const char>);

} // namespace taut::impl
