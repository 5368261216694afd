// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include <taut/impl/core/sparse/block_matrix.hpp>
#include <taut/impl/core/sparse/transfer_lists.hpp>

namespace taut::impl
{

/// Between a fine and a coarse block matrix: interpolation P, restriction P' and the values of P' A P, each one launch.
/// P is stored by rows, and of its transpose where the weights are; the product P' A P needs no list of
/// its own.
class block_transfer
{
public:
    block_transfer(const block_matrix& fine, const transfer_weights& P, const block_matrix& coarse);
    /// The lists are of the patterns of both matrices, and may go afterwards. Throws parameter_error.
    block_transfer(const block_matrix& fine, const transfer_lists& lists, const block_matrix& coarse);

    /// x += P coarse
    void prolong(const device_vector& coarse, device_vector& x) const;
    /// b = P' r and x = scale B^-1 b, with B the block diagonal of the coarse matrix
    void restrict_residual(const device_vector& r, const block_matrix& coarse, double scale, device_vector& b,
                           device_vector& x) const;
    /// coarse = P' fine P. The diagonal is not inverted.
    void refresh(const block_matrix& fine, block_matrix& coarse) const;

    /// Places a row of P.
    int K() const noexcept { return K_; }
    /// Columns and weights of P at [k * stride + row], for places k < K.
    const buffer<idx>& columns() const noexcept { return columns_; }
    const real_buffer& weights() const noexcept { return weights_; }

    /// Bytes of the lists.
    std::size_t bytes() const;

private:
    void upload(const std::optional<impl::product_groups>& groups, const block_matrix& coarse);

    mutable queue queue_;
    lane_form form_;
    int K_;
    idx fine_stride_, stride_, group_size_ = 1, colour_count_ = 0;
    range product_items_{0};
    buffer<idx> columns_, transpose_offsets_, transpose_, codes_, colours_, visit_offsets_, visits_;
    real_buffer weights_, column_weights_;
    impl::late_kernel prolong_, restrict_, galerkin_;
};

} // namespace taut::impl
