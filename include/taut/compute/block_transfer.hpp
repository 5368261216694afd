// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <taut/compute/block_sparse.hpp>
#include <taut/compute/product_groups.hpp>

namespace taut
{

/// Between a fine and a coarse block matrix: interpolation P, restriction P' and the values of P' A P, each one launch.
/// Weights are T. P is stored by rows, and of its transpose where the weights are; the product P' A P needs no list of
/// its own.
template <class T>
class block_transfer
{
public:
    block_transfer(const block_matrix<T>& fine, const transfer_weights& P, const block_matrix<T>& coarse)
        : block_transfer(fine, P, transposed_weights(P), coarse)
    {
    }
    /// The coarse matrix has the pattern pattern_of_product(fine.pattern(), P), and t is the transpose of P. Throws
    /// parameter_error.
    block_transfer(const block_matrix<T>& fine, const transfer_weights& P, const transposed_weights& t,
                   const block_matrix<T>& coarse)
        : queue_(fine.queue()),
          form_(fine.form()),
          fine_stride_(static_cast<index>(fine.stride())),
          stride_(static_cast<index>(coarse.stride()))
    {
        if (P.columns.size() != fine.rows() || P.coarse != coarse.rows())
            throw parameter_error("transfer_weights", "does not fit the matrices");
        make_prolongation(P);
        make_transpose(P, t);
        make_groups(P, t, coarse);
        const int D = fine.block_size();
        detail::load_block_kernel<T>(prolong_, queue_, "prolong", D, form_);
        detail::load_block_kernel<T>(restrict_, queue_, "restrict_residual", D, form_);
        detail::load_block_kernel<T>(galerkin_, queue_, "galerkin", D, form_);
    }

    /// x += P coarse
    void prolong(const device_vector<T>& coarse, device_vector<T>& x) const
    {
        prolong_(form_.items(static_cast<std::size_t>(fine_stride_)), fine_stride_, stride_, columns_, weights_,
                 coarse.data(), x.data());
    }
    /// b = P' r and x = scale B^-1 b, with B the block diagonal of the coarse matrix
    void restrict_residual(const device_vector<T>& r, const block_matrix<T>& coarse, double scale, device_vector<T>& b,
                           device_vector<T>& x) const
    {
        restrict_(form_.items(static_cast<std::size_t>(stride_)), fine_stride_, stride_, transpose_offsets_, transpose_,
                  weights_, r.data(), coarse.inverse(), T(scale), b.data(), x.data());
    }
    /// coarse = P' fine P. The diagonal is not inverted.
    void refresh(const block_matrix<T>& fine, block_matrix<T>& coarse) const
    {
        galerkin_(product_items_, static_cast<index>(coarse.rows()), fine_stride_, group_size_, colour_count_,
                  transpose_offsets_, transpose_, columns_, weights_, codes_, colours_, visit_offsets_, visits_,
                  fine.offsets(), fine.columns(), fine.values(), coarse.offsets(), coarse.columns(), coarse.values());
    }

    /// Columns and weights of P at [k * stride + row], for places k < 3.
    const buffer<index>& columns() const noexcept { return columns_; }
    const buffer<T>& weights() const noexcept { return weights_; }

    /// Bytes of the lists.
    std::size_t bytes() const
    {
        return columns_.bytes() + weights_.bytes() + transpose_offsets_.bytes() + transpose_.bytes() + codes_.bytes() +
               colours_.bytes() + visit_offsets_.bytes() + visits_.bytes();
    }

private:
    void make_prolongation(const transfer_weights& P)
    {
        const auto stride = static_cast<std::size_t>(fine_stride_);
        std::vector<index> columns(3 * stride, 0);
        std::vector<T> weights(3 * stride, T(0));
        parallel_for(P.columns.size(),
                     [&](std::size_t begin, std::size_t end)
                     {
                         for (std::size_t i = begin; i < end; ++i)
                         {
                             // Places without a weight repeat a column that has one.
                             std::size_t used = 0;
                             while (used < 2 && P.weight(i, used) == 0) ++used;
                             for (std::size_t k = 0; k < 3; ++k)
                             {
                                 const double w = P.weight(i, k);
                                 columns[k * stride + i] = P.columns[i][w == 0 ? used : k];
                                 weights[k * stride + i] = static_cast<T>(w);
                             }
                         }
                     });
        columns_ = buffer<index>(queue_, columns);
        weights_ = buffer<T>(queue_, weights);
    }

    void make_transpose(const transfer_weights& P, const transposed_weights& t)
    {
        const auto C = static_cast<std::size_t>(form_.slice);
        std::vector<detail::list_chunk> chunks(detail::chunk_count(P.coarse));
        detail::for_each_chunk(P.coarse,
                               [&](std::size_t chunk, std::size_t begin, std::size_t end)
                               {
                                   auto& [items, sizes] = chunks[chunk];
                                   for (std::size_t first = begin; first < end; first += C)
                                   {
                                       const std::size_t last = std::min(first + C, end), base = items.size();
                                       std::size_t width = 0;
                                       for (std::size_t J = first; J < last; ++J) width = std::max(width, t[J].size());
                                       items.resize(base + width * C, -1);
                                       for (std::size_t J = first; J < last; ++J)
                                           for (std::size_t n = 0; n < t[J].size(); ++n)
                                               items[base + n * C + J % C] = t[J][n] % 3 * fine_stride_ + t[J][n] / 3;
                                       sizes.push_back(static_cast<index>(width * C));
                                   }
                               });
        transpose_offsets_ =
            buffer<index>(queue_, detail::slice_offsets(chunks, static_cast<std::size_t>(stride_) / C));
        transpose_ = detail::upload_lists(queue_, chunks);
    }

    /// For the product on CPUs; elsewhere an item does a row.
    void make_groups(const transfer_weights& P, const transposed_weights& t, const block_matrix<T>& coarse)
    {
        if (form_.lanes == 1)
        {
            for (auto* unused : {&codes_, &colours_, &visit_offsets_, &visits_}) *unused = buffer<index>(queue_, 1);
            product_items_ = form_.items(coarse.stride());
            return;
        }
        // Large groups share more fine rows; small levels need some groups for all cores.
        constexpr std::size_t few = 32;
        const std::size_t size = std::clamp<std::size_t>(padded(coarse.rows() / few, 16), 16, detail::product_group);
        const detail::product_groups groups(P, t, coarse.pattern(), size);
        codes_ = buffer<index>(queue_, groups.codes);
        colours_ = buffer<index>(queue_, groups.colours);
        visit_offsets_ = buffer<index>(queue_, groups.offsets);
        visits_ = buffer<index>(queue_, groups.visits);
        product_items_ = {groups.offsets.size() - 1, 1};
        group_size_ = static_cast<index>(size);
        colour_count_ = groups.count;
    }

    mutable queue queue_;
    lane_form form_;
    index fine_stride_, stride_, group_size_ = 1, colour_count_ = 0;
    range product_items_{0};
    buffer<index> columns_, transpose_offsets_, transpose_, codes_, colours_, visit_offsets_, visits_;
    buffer<T> weights_;
    using in = const buffer<T>;
    using list = const buffer<index>;
    typed_kernel<index, index, list, in, in, buffer<T>> prolong_;
    typed_kernel<index, index, list, list, in, in, in, T, buffer<T>, buffer<T>> restrict_;
    typed_kernel<index, index, index, index, list, list, list, in, list, list, list, list, list, list, in, list, list,
                 buffer<T>>
        galerkin_;
};

} // namespace taut
