// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include <taut/impl/core/sparse/dense_inverse.hpp>

namespace taut::impl
{

dense_inverse::dense_inverse(const block_matrix& A, const std::vector<idx>& rows)
    : rows_(static_cast<idx>(A.rows())), size_(static_cast<idx>(rows.size()) * A.block_size())
{
    if (size_ == 0) return;
    auto& q = A.queue();
    const auto form = A.form();
    const auto size = static_cast<std::size_t>(size_),
               pitch = padded(size, static_cast<std::size_t>(std::max(form.lanes, idx{16})));
    pitch_ = static_cast<idx>(pitch);
    std::vector<idx> numbers(A.rows(), -1), at;
    for (const idx r : rows)
    {
        numbers[static_cast<std::size_t>(r)] = static_cast<idx>(at.size()) / A.block_size();
        for (int c = 0; c < A.block_size(); ++c) at.push_back(static_cast<idx>(A.stride()) * c + r);
    }
    numbers_ = buffer<idx>(q, numbers);
    at_ = buffer<idx>(q, at);
    work_ = real_buffer(q, A.type(), (size + 2) * pitch);
    inverse_ = real_buffer(q, A.type(), size * pitch);
    items_ = form.shared_items(padded(pitch, static_cast<std::size_t>(form.lanes)));
    const auto team = static_cast<std::size_t>(form.team());
    team_ = {team, team};
    invert_ = block_kernel(q, "invert_dense", A.type(), A.block_size(), form);
    apply_ = block_kernel(q, "dense", A.type(), A.block_size(), form);
}

void dense_inverse::refresh(const block_matrix& A)
{
    invert_(team_, {{"rows", rows_},
                    {"size", size_},
                    {"pitch", pitch_},
                    {"shift", A.type() == scalar_type::f64 ? 1e-8 : 1e-4},
                    {"offsets", A.offsets()},
                    {"columns", A.columns()},
                    {"A", A.values()},
                    {"numbers", numbers_},
                    {"work", work_},
                    {"X", inverse_}});
}

void dense_inverse::apply(const device_vector& b, device_vector& x) const
{
    apply_(items_,
           {{"size", size_}, {"pitch", pitch_}, {"at", at_}, {"inverse", inverse_}, {"b", b.data()}, {"x", x.data()}});
}

} // namespace taut::impl
