// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <vector>

#include <taut/sparse/block_matrix.hpp>

namespace taut::detail
{

/// The inverse of a small symmetric positive semi-definite block matrix on its device, dense, for some of its rows.
/// The matrix is scaled to a unit diagonal and shifted a little, so that directions which it does not see get a large,
/// finite answer; unknowns without a positive pivot, or whose entries are not finite, get 0. Only enqueues.
template <class T>
class dense_inverse
{
public:
    /// None: empty() holds.
    dense_inverse() = default;

    /// rows: of A, ascending, each once.
    dense_inverse(const block_matrix<T>& A, const std::vector<idx>& rows)
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
        work_ = buffer<T>(q, (size + 2) * pitch);
        inverse_ = buffer<T>(q, size * pitch);
        items_ = form.items(padded(pitch, static_cast<std::size_t>(form.lanes)));
        const auto team = static_cast<std::size_t>(form.team());
        team_ = {team, team};
        load_block_kernel<T>(invert_, q, "invert_dense", A.block_size(), form);
        load_block_kernel<T>(apply_, q, "dense", A.block_size(), form);
    }

    bool empty() const noexcept { return size_ == 0; }
    idx size() const noexcept { return size_; }
    idx pitch() const noexcept { return pitch_; }
    /// Where the unknowns are in vectors of the matrix.
    const buffer<idx>& at() const noexcept { return at_; }
    const buffer<T>& inverse() const noexcept { return inverse_; }

    void refresh(const block_matrix<T>& A)
    {
        invert_(team_, rows_, size_, pitch_, T(std::is_same_v<T, double> ? 1e-8 : 1e-4), A.offsets(), A.columns(),
                A.values(), numbers_, work_, inverse_);
    }
    /// x = A^-1 b at the rows; other places of x stay as they are.
    void apply(const device_vector<T>& b, device_vector<T>& x) const
    {
        apply_(items_, size_, pitch_, at_, inverse_, b.data(), x.data());
    }

    std::size_t bytes() const { return numbers_.bytes() + at_.bytes() + work_.bytes() + inverse_.bytes(); }

private:
    idx rows_ = 0, size_ = 0, pitch_ = 0;
    range items_{0}, team_{0};
    buffer<idx> numbers_, at_;
    buffer<T> work_, inverse_;
    using in = const buffer<T>;
    using list = const buffer<idx>;
    typed_kernel<idx, idx, idx, T, list, list, in, list, buffer<T>, buffer<T>> invert_;
    typed_kernel<idx, idx, list, in, in, buffer<T>> apply_;
};

} // namespace taut::detail
