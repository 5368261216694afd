// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_ARRAYS_HPP
#define TAUT_ARRAYS_HPP

#include <array>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <taut/errors.hpp>
#include <taut/types.hpp>

/// Views of arrays of a program: points and cells are read where they lie.
namespace taut
{

/// View of rows of K numbers in the memory of a program: row i begins `stride` bytes after row i - 1, wherever that is
/// (a packed array, an interleaved vertex buffer, every second row), and its numbers are `step` bytes apart (a matrix
/// by columns, coordinates in arrays of their own). It refers to the memory; T is const where it is only read.
template <class T, int K>
    requires std::is_arithmetic_v<std::remove_const_t<T>>
class array_view
{
    using byte = std::conditional_t<std::is_const_v<T>, const std::byte, std::byte>;

public:
    using value_type = std::remove_const_t<T>;
    using row_type = std::array<value_type, static_cast<std::size_t>(K)>;

    array_view() = default;
    array_view(T* first, std::size_t rows, std::size_t stride = K * sizeof(T), std::size_t step = sizeof(T))
        : first_(reinterpret_cast<byte*>(first)), rows_(rows), stride_(stride), step_(step)
    {
    }
    /// Packed numbers. Throws parameter_error unless their count is a multiple of K.
    explicit array_view(std::span<T> packed) : array_view(packed.data(), packed.size() / K)
    {
        if (packed.size() % K != 0)
            throw parameter_error("array_view",
                                  std::to_string(packed.size()) + " numbers are not rows of " + std::to_string(K));
    }

    std::size_t rows() const noexcept { return rows_; }

    /// A copy of row i, which need not be aligned.
    row_type operator[](std::size_t i) const
    {
        row_type row;
        for (std::size_t k = 0; k < row.size(); ++k) std::memcpy(&row[k], at(i, k), sizeof row[k]);
        return row;
    }
    void set(std::size_t i, const row_type& row) const requires(!std::is_const_v<T>)
    {
        for (std::size_t k = 0; k < row.size(); ++k) std::memcpy(at(i, k), &row[k], sizeof row[k]);
    }

    /// The rows as points.
    std::vector<vec<K>> points() const requires std::floating_point<value_type>
    {
        std::vector<vec<K>> x(rows_);
        for (std::size_t v = 0; v < x.size(); ++v)
        {
            const row_type row = (*this)[v];
            for (int k = 0; k < K; ++k) x[v][k] = static_cast<double>(row[static_cast<std::size_t>(k)]);
        }
        return x;
    }

    /// Stores points in the rows, rounded to their type; a map that is certified in double may fold where it is rounded
    /// to float, so certify<D>(cells, rows.points()) tells whether what was stored did. Throws parameter_error for
    /// another number of points.
    void store(std::span<const vec<K>> x) const requires std::floating_point<T>
    {
        if (rows_ != x.size())
            throw parameter_error("rows", std::to_string(rows_) + " rows for " + std::to_string(x.size()) +
                                              " points; give one per point");
        for (std::size_t v = 0; v < x.size(); ++v)
        {
            row_type row;
            for (int k = 0; k < K; ++k) row[static_cast<std::size_t>(k)] = static_cast<T>(x[v][k]);
            set(v, row);
        }
    }

private:
    byte* at(std::size_t i, std::size_t k) const { return first_ + i * stride_ + k * step_; }

    byte* first_ = nullptr;
    std::size_t rows_ = 0, stride_ = 0, step_ = 0;
};

} // namespace taut

#endif
#include <taut/impl/leave.inl>
