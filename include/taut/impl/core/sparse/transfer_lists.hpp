// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <taut/impl/core/compute/lane_form.hpp>
#include <taut/impl/core/sparse/product_groups.hpp>

namespace taut::impl
{

/// An interpolation and its transpose as block_transfer has them on a device, made on the host.
struct transfer_lists
{
    /// coarse: pattern_of_product(fine, P), and t is the transpose of P. Throws parameter_error.
    transfer_lists(const block_pattern& fine, const transfer_weights& P, const transposed_weights& t,
                   const block_pattern& coarse, lane_form form);

    std::size_t K; ///< places per row
    std::size_t fine_stride, fine_rows, coarse_rows;
    std::vector<idx> columns;    ///< at [k * fine_stride + row], for places k < K
    std::vector<double> weights; ///< alike
    std::vector<idx> transpose_offsets;
    std::vector<idx> transpose;                 ///< places in `weights`
    std::optional<impl::product_groups> groups; ///< for the product on CPUs; elsewhere an item does a row

private:
    idx device_place(idx place) const;

    void make_prolongation(const transfer_weights& P);

    void make_transpose(const transfer_weights& P, const transposed_weights& t, const block_pattern& coarse);
};

} // namespace taut::impl
