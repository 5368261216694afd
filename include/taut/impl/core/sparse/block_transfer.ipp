// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/sparse/block_transfer.hpp>

namespace taut::impl
{

block_transfer::block_transfer(const block_matrix& fine, const transfer_weights& P, const block_matrix& coarse)
    : block_transfer(fine, transfer_lists(fine.pattern(), P, transposed_weights(P), coarse.pattern(), fine.form()),
                     coarse)
{
}

block_transfer::block_transfer(const block_matrix& fine, const transfer_lists& lists, const block_matrix& coarse)
    : queue_(fine.queue()),
      form_(fine.form()),
      K_(static_cast<int>(lists.K)),
      fine_stride_(static_cast<idx>(fine.stride())),
      stride_(static_cast<idx>(coarse.stride())),
      columns_(queue_, lists.columns),
      transpose_offsets_(queue_, lists.transpose_offsets),
      transpose_(queue_, lists.transpose),
      weights_(queue_, fine.type(), lists.weights)
{
    if (lists.fine_rows != fine.rows() || lists.coarse_rows != coarse.rows())
        throw parameter_error("transfer_lists", "do not fit the matrices");
    upload(lists.groups, coarse);
    const auto get = [&](const char* name)
    { return impl::transfer_kernel(queue_, name, fine.type(), fine.block_size(), K_, form_); };
    prolong_ = get("prolong");
    restrict_ = get("restrict_residual");
    galerkin_ = get("galerkin");
}

void block_transfer::prolong(const device_vector& coarse, device_vector& x) const
{
    prolong_(form_.items(static_cast<std::size_t>(fine_stride_)), {{"stride", fine_stride_},
                                                                   {"coarse_stride", stride_},
                                                                   {"columns", columns_},
                                                                   {"weights", weights_},
                                                                   {"coarse", coarse.data()},
                                                                   {"x", x.data()}});
}

void block_transfer::restrict_residual(const device_vector& r, const block_matrix& coarse, double scale,
                                       device_vector& b, device_vector& x) const
{
    restrict_(form_.items(static_cast<std::size_t>(stride_)), {{"fine_stride", fine_stride_},
                                                               {"stride", stride_},
                                                               {"offsets", transpose_offsets_},
                                                               {"transpose", transpose_},
                                                               {"weights", weights_},
                                                               {"r", r.data()},
                                                               {"inverse", coarse.inverse()},
                                                               {"scale", scale},
                                                               {"b", b.data()},
                                                               {"x", x.data()}});
}

void block_transfer::refresh(const block_matrix& fine, block_matrix& coarse) const
{
    galerkin_(product_items_, {{"rows", static_cast<idx>(coarse.rows())},
                               {"fine_stride", fine_stride_},
                               {"size", group_size_},
                               {"count", colour_count_},
                               {"transpose_offsets", transpose_offsets_},
                               {"transpose", transpose_},
                               {"prolongation", columns_},
                               {"weights", weights_},
                               {"column_weights", column_weights_},
                               {"codes", codes_},
                               {"colours", colours_},
                               {"visit_offsets", visit_offsets_},
                               {"visits", visits_},
                               {"fine_offsets", fine.offsets()},
                               {"fine_columns", fine.columns()},
                               {"fine", fine.values()},
                               {"offsets", coarse.offsets()},
                               {"columns", coarse.columns()},
                               {"coarse", coarse.values()}});
}

std::size_t block_transfer::bytes() const
{
    return columns_.bytes() + weights_.bytes() + transpose_offsets_.bytes() + transpose_.bytes() +
           column_weights_.bytes() + codes_.bytes() + colours_.bytes() + visit_offsets_.bytes() + visits_.bytes();
}

void block_transfer::upload(const std::optional<impl::product_groups>& groups, const block_matrix& coarse)
{
    if (!groups)
    {
        column_weights_ = real_buffer(queue_, weights_.type(), 1);
        for (auto* unused : {&codes_, &colours_, &visit_offsets_, &visits_}) *unused = buffer<idx>(queue_, 1);
        product_items_ = form_.shared_items(coarse.stride());
        return;
    }
    codes_ = buffer<idx>(queue_, groups->codes);
    colours_ = buffer<idx>(queue_, groups->colours);
    column_weights_ = real_buffer(queue_, weights_.type(), groups->weights);
    visit_offsets_ = buffer<idx>(queue_, groups->offsets);
    visits_ = buffer<idx>(queue_, groups->visits);
    product_items_ = {groups->offsets.size() - 1, 1};
    group_size_ = static_cast<idx>(groups->size);
    colour_count_ = groups->count;
}

} // namespace taut::impl
