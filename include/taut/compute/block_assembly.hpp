// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <taut/compute/block_sparse.hpp>
#include <taut/compute/cell_pattern.hpp>

namespace taut
{

/// Sums element blocks into a block matrix. An element with K corners gives one block for each pair k <= l of its
/// corners, pairs in the order (0,0), (0,1), .., (0,K-1), (1,1), ..: a block (k, k) has its upper triangle by rows, D
/// (D
/// + 1) / 2 entries, the others all D * D by rows, and row r of the block (k, l) belongs to component r of corner k.
/// The block (l, k) is its transpose. Entry n of all blocks of a cell lies at [n * cell_stride + cell]. Deterministic,
/// without atomics; one launch.
template <class T>
class block_assembly
{
public:
    template <class Cells>
    block_assembly(const block_matrix<T>& A, const Cells& cells, std::size_t cell_stride,
                   std::span<const char> fixed = {})
        : block_assembly(A, cells, incidence_of_cells(cells, A.rows()), cell_stride, fixed)
    {
    }

    /// cells: arrays of corner numbers, in the pattern of A. fixed: a flag a row, or none; rows and columns that are
    /// fixed stay 0, diagonals included. It serves all matrices like A. Throws parameter_error.
    template <class Cells>
    block_assembly(const block_matrix<T>& A, const Cells& cells, const cell_incidence& around, std::size_t cell_stride,
                   std::span<const char> fixed = {})
        : queue_(A.queue()),
          items_(A.form().items(A.stride())),
          values_(A.values().size()),
          cells_(static_cast<index>(cell_stride))
    {
        constexpr std::size_t K = cell_corners<Cells>;
        const auto D = static_cast<std::size_t>(A.block_size());
        if (cells.size() > cell_stride) throw parameter_error("cell_stride", "is less than the number of cells");
        if (around.offsets.size() != A.rows() + 1) throw parameter_error("around", "is of another mesh");
        if (!fixed.empty() && fixed.size() != A.rows()) throw parameter_error("fixed", "needs one flag a row, or none");
        std::array<std::array<std::size_t, K>, K> first{}; // entry 0 of the block of each pair
        std::size_t entries = 0;
        for (std::size_t k = 0; k < K; ++k)
            for (std::size_t l = k; l < K; ++l)
            {
                first[k][l] = first[l][k] = entries * cell_stride;
                entries += k == l ? D * (D + 1) / 2 : D * D;
            }
        if (entries * cell_stride >= static_cast<std::size_t>(none))
            throw parameter_error("block_assembly", "more than 2^31 entries of element blocks");
        if (cells.size() > 0) reach_ = (entries - 1) * cell_stride + cells.size();

        const auto& pattern = A.pattern();
        const auto is_fixed = [&](index v) { return !fixed.empty() && fixed[static_cast<std::size_t>(v)]; };
        std::vector<detail::list_chunk> diagonal(detail::chunk_count(A.rows())), others(diagonal.size());
        const auto make = [&](std::size_t chunk, std::size_t begin, std::size_t end)
        {
            const auto C = static_cast<std::size_t>(pattern.slice);
            slice_lists lists(C);
            detail::sliced_row row;
            for (std::size_t start = begin; start < end; start += C)
            {
                lists.begin(pattern.width(start));
                for (std::size_t v = start; v < std::min(start + C, end); ++v)
                {
                    if (is_fixed(static_cast<index>(v))) continue;
                    row.read(pattern, v);
                    for (index n = around.offsets[v]; n < around.offsets[v + 1]; ++n)
                    {
                        const auto corner = static_cast<std::size_t>(around.corners[static_cast<std::size_t>(n)]);
                        const std::size_t cell = corner / K, k = corner % K;
                        lists.add(0, v % C, static_cast<index>(first[k][k] + cell));
                        for (std::size_t l = 0; l < K; ++l)
                        {
                            const index w = cells[cell][l];
                            if (l == k || is_fixed(w)) continue;
                            const auto slot = static_cast<index>(first[k][l] + cell);
                            lists.add(row.find(w), v % C, k < l ? slot : ~slot);
                        }
                    }
                }
                lists.finish(diagonal[chunk], others[chunk]);
            }
        };
        detail::for_each_chunk(A.rows(), make);
        const auto C = static_cast<std::size_t>(pattern.slice);
        diagonal_offsets_ = buffer<index>(queue_, detail::slice_offsets(diagonal, A.stride() / C));
        diagonal_slots_ = detail::upload_lists(queue_, diagonal);
        slot_offsets_ = buffer<index>(queue_, detail::slice_offsets(others, pattern.columns.size() / C));
        slots_ = detail::upload_lists(queue_, others);
        detail::load_block_kernel<T>(assemble_, queue_, "assemble", A.block_size(), A.form());
    }

    /// Enqueues the sums into the values of A. Its diagonal is not inverted.
    void operator()(const buffer<T>& blocks, block_matrix<T>& A) const
    {
        if (blocks.size() < reach_ || A.values().size() != values_)
            throw parameter_error("block_assembly", "blocks of " + std::to_string(reach_) +
                                                        " numbers and a matrix of the same pattern are needed");
        if (slots_.empty() && diagonal_slots_.empty()) return A.values().fill(0);
        assemble_(items_, cells_, A.offsets(), diagonal_offsets_, diagonal_slots_, slot_offsets_, slots_, blocks,
                  A.values());
    }

    /// Bytes of the lists.
    std::size_t bytes() const
    {
        return diagonal_offsets_.bytes() + diagonal_slots_.bytes() + slot_offsets_.bytes() + slots_.bytes();
    }

private:
    static constexpr index none = 0x7fffffff;

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
        void add(std::size_t j, std::size_t lane, index slot)
        {
            const std::size_t place = j * C_ + lane;
            all_.push_back({static_cast<index>(place), counts_[place]++, slot});
        }
        /// Appends them; those of nonzero 0 to `diagonal`.
        void finish(detail::list_chunk& diagonal, detail::list_chunk& others)
        {
            starts_.clear();
            for (std::size_t p = 0; p < counts_.size(); p += C_)
            {
                auto& [items, sizes] = p == 0 ? diagonal : others;
                const auto* count = counts_.data() + p;
                const index size = *std::max_element(count, count + C_) * static_cast<index>(C_);
                starts_.push_back(items.size());
                items.resize(items.size() + static_cast<std::size_t>(size), none);
                sizes.push_back(size);
                if (p == 0) others.sizes.push_back(0); // its places have a number among all places
            }
            for (const auto& [place, number, slot] : all_)
            {
                const auto p = static_cast<std::size_t>(place);
                auto& items = p < C_ ? diagonal.items : others.items;
                items[starts_[p / C_] + static_cast<std::size_t>(number) * C_ + p % C_] = slot;
            }
        }

    private:
        struct item
        {
            index place, number, slot;
        };
        std::size_t C_;
        std::vector<index> counts_;
        std::vector<item> all_;
        std::vector<std::size_t> starts_;
    };

    mutable queue queue_;
    range items_;
    std::size_t values_, reach_ = 0;
    index cells_;
    buffer<index> diagonal_offsets_, diagonal_slots_, slot_offsets_, slots_;
    using list = const buffer<index>;
    typed_kernel<index, list, list, list, list, list, const buffer<T>, buffer<T>> assemble_;
};

} // namespace taut
