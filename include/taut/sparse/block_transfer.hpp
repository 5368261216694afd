// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include <taut/sparse/block_matrix.hpp>
#include <taut/sparse/transfer_lists.hpp>

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
        : block_transfer(
              fine, transfer_lists<T>(fine.pattern(), P, transposed_weights(P), coarse.pattern(), fine.form()), coarse)
    {
    }
    /// The lists are of the patterns of both matrices, and may go afterwards. Throws parameter_error.
    block_transfer(const block_matrix<T>& fine, const transfer_lists<T>& lists, const block_matrix<T>& coarse)
        : queue_(fine.queue()),
          form_(fine.form()),
          fine_stride_(static_cast<idx>(fine.stride())),
          stride_(static_cast<idx>(coarse.stride())),
          columns_(queue_, lists.columns),
          transpose_offsets_(queue_, lists.transpose_offsets),
          transpose_(queue_, lists.transpose),
          weights_(queue_, lists.weights)
    {
        if (lists.fine_rows != fine.rows() || lists.coarse_rows != coarse.rows())
            throw parameter_error("transfer_lists", "do not fit the matrices");
        upload(lists.groups, coarse);
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
        galerkin_(product_items_, static_cast<idx>(coarse.rows()), fine_stride_, group_size_, colour_count_,
                  transpose_offsets_, transpose_, columns_, weights_, codes_, colours_, visit_offsets_, visits_,
                  fine.offsets(), fine.columns(), fine.values(), coarse.offsets(), coarse.columns(), coarse.values());
    }

    /// Columns and weights of P at [k * stride + row], for places k < 3.
    const buffer<idx>& columns() const noexcept { return columns_; }
    const buffer<T>& weights() const noexcept { return weights_; }

    /// Bytes of the lists.
    std::size_t bytes() const
    {
        return columns_.bytes() + weights_.bytes() + transpose_offsets_.bytes() + transpose_.bytes() + codes_.bytes() +
               colours_.bytes() + visit_offsets_.bytes() + visits_.bytes();
    }

private:
    void upload(const std::optional<detail::product_groups>& groups, const block_matrix<T>& coarse)
    {
        if (!groups)
        {
            for (auto* unused : {&codes_, &colours_, &visit_offsets_, &visits_}) *unused = buffer<idx>(queue_, 1);
            product_items_ = form_.items(coarse.stride());
            return;
        }
        codes_ = buffer<idx>(queue_, groups->codes);
        colours_ = buffer<idx>(queue_, groups->colours);
        visit_offsets_ = buffer<idx>(queue_, groups->offsets);
        visits_ = buffer<idx>(queue_, groups->visits);
        product_items_ = {groups->offsets.size() - 1, 1};
        group_size_ = static_cast<idx>(groups->size);
        colour_count_ = groups->count;
    }

    mutable queue queue_;
    lane_form form_;
    idx fine_stride_, stride_, group_size_ = 1, colour_count_ = 0;
    range product_items_{0};
    buffer<idx> columns_, transpose_offsets_, transpose_, codes_, colours_, visit_offsets_, visits_;
    buffer<T> weights_;
    using in = const buffer<T>;
    using list = const buffer<idx>;
    typed_kernel<idx, idx, list, in, in, buffer<T>> prolong_;
    typed_kernel<idx, idx, list, list, in, in, in, T, buffer<T>, buffer<T>> restrict_;
    typed_kernel<idx, idx, idx, idx, list, list, list, in, list, list, list, list, list, list, in, list, list,
                 buffer<T>>
        galerkin_;
};

} // namespace taut
