// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <taut/impl/core/sparse/block_matrix.hpp>

namespace taut::impl
{

/// The inverse of a small symmetric positive semi-definite block matrix on its device, dense, for some of its rows.
/// The matrix is scaled to a unit diagonal and shifted a little, so that directions which it does not see get a large,
/// finite answer; unknowns without a positive pivot, or whose entries are not finite, get 0. Only enqueues.
class dense_inverse
{
public:
    /// None: empty() holds.
    dense_inverse() = default;

    /// rows: of A, ascending, each once.
    dense_inverse(const block_matrix& A, const std::vector<idx>& rows);

    bool empty() const noexcept { return size_ == 0; }
    idx size() const noexcept { return size_; }
    idx pitch() const noexcept { return pitch_; }
    /// Indices of the unknowns in vectors of the matrix.
    const buffer<idx>& at() const noexcept { return at_; }
    const real_buffer& inverse() const noexcept { return inverse_; }

    void refresh(const block_matrix& A);
    /// x = A^-1 b at the rows; other places of x stay as they are.
    void apply(const device_vector& b, device_vector& x) const;

    std::size_t bytes() const { return numbers_.bytes() + at_.bytes() + work_.bytes() + inverse_.bytes(); }

private:
    idx rows_ = 0, size_ = 0, pitch_ = 0;
    range items_{0}, team_{0};
    buffer<idx> numbers_, at_;
    real_buffer work_, inverse_;
    late_kernel invert_, apply_;
};

} // namespace taut::impl
