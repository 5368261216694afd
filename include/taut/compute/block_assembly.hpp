// SPDX-License-Identifier: MIT
#pragma once

#include <taut/compute/block_sparse.hpp>

namespace taut
{

/// Sums element blocks into a block matrix. An element with K corners gives one block for each pair k <= l of its
/// corners, pairs in the order (0,0), (0,1), .., (0,K-1), (1,1), ..: entry (r, c) of the block of pair p lies at
/// [(p * D * D + r * D + c) * cell_stride + cell] and couples component r of corner k with component c of corner l. The
/// block (l, k) is its transpose. Deterministic, without atomics; one launch.
template <class T>
class block_assembly
{
public:
    /// cells: arrays of corner numbers, in the pattern of A. fixed: a flag a row, or none; rows and columns that are
    /// fixed stay 0, diagonals included. Refers to the layout of A alone: any matrix built alike can be assembled.
    template <class Cells>
    block_assembly(const block_matrix<T>& A, const Cells& cells, std::size_t cell_stride,
                   std::span<const char> fixed = {})
        : queue_(A.queue()), form_(A.form()), values_(A.values().size()), cells_(static_cast<index>(cell_stride))
    {
        const auto& pattern = A.pattern();
        const auto C = static_cast<std::size_t>(form_.slice), D = static_cast<std::size_t>(A.block_size());
        if (cells.size() > cell_stride) throw parameter_error("cell_stride", "is less than the number of cells");
        if (!fixed.empty() && fixed.size() != A.rows()) throw parameter_error("fixed", "needs one flag a row, or none");
        const auto is_fixed = [&](index v) { return !fixed.empty() && fixed[static_cast<std::size_t>(v)]; };

        // Calls visit(place in the matrix, slot) for each block of each element.
        const auto each = [&](const auto& visit)
        {
            for (std::size_t cell = 0; cell < cells.size(); ++cell)
            {
                std::size_t pair = 0;
                const std::size_t K = cells[cell].size();
                for (std::size_t k = 0; k < K; ++k)
                    for (std::size_t l = k; l < K; ++l, ++pair)
                    {
                        const index v = cells[cell][k], w = cells[cell][l];
                        if (is_fixed(v) || is_fixed(w)) continue;
                        const std::size_t slot = pair * D * D * cell_stride + cell;
                        reach_ = std::max(reach_, slot + (D * D - 1) * cell_stride + 1);
                        if (reach_ >= std::size_t{0x7fffffff})
                            throw parameter_error("block_assembly", "more than 2^31 entries of element blocks");
                        const auto at = [&](index r, index c)
                        {
                            const std::size_t j = pattern.find(static_cast<std::size_t>(r), c);
                            if (j == pattern.length(static_cast<std::size_t>(r)))
                                throw parameter_error("cells", "couple vertices that the pattern does not");
                            return A.lists().place(static_cast<std::size_t>(r), j);
                        };
                        visit(at(v, w), static_cast<index>(slot));
                        if (k != l) visit(at(w, v), ~static_cast<index>(slot));
                    }
            }
        };
        const std::size_t places = A.lists().size();
        std::vector<index> length(places, 0);
        each([&](std::size_t place, index) { ++length[place]; });
        const sliced_lists lists(places, places, form_.slice, [&](std::size_t p) { return length[p]; });
        std::vector<index> slots(lists.size(), 0x7fffffff); // no slot
        std::fill(length.begin(), length.end(), 0);
        each([&](std::size_t place, index slot)
             { slots[lists.place(place, static_cast<std::size_t>(length[place]++))] = slot; });

        slices_ = static_cast<index>(places / C);
        offsets_ = buffer<index>(queue_, lists.offsets);
        slots_ = buffer<index>(queue_, slots);
        detail::load_block_kernel<T>(assemble_, queue_, "assemble", A.block_size(), form_);
    }

    /// Enqueues the sums into the values of A. Its diagonal is not inverted.
    void operator()(const buffer<T>& blocks, block_matrix<T>& A) const
    {
        if (blocks.size() < reach_ || A.values().size() != values_)
            throw parameter_error("block_assembly", "blocks of " + std::to_string(reach_) +
                                                        " numbers and a matrix of the same pattern are needed");
        if (reach_ == 0) return A.values().fill(0);
        assemble_(form_.items(static_cast<std::size_t>(slices_ * form_.slice)), slices_, cells_, offsets_, slots_,
                  blocks, A.values());
    }

private:
    mutable queue queue_;
    lane_form form_;
    std::size_t values_, reach_ = 0;
    index cells_, slices_ = 0;
    buffer<index> offsets_, slots_;
    using list = const buffer<index>;
    typed_kernel<index, index, list, list, const buffer<T>, buffer<T>> assemble_;
};

} // namespace taut
