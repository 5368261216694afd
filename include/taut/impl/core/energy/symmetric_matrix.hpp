// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace taut::impl
{

/// A symmetric N x N matrix of numbers or of traced scalars, kept as its upper triangle.
template <class T, int N>
class symmetric_matrix
{
public:
    T& operator()(int i, int j) { return entries_[place(i, j)]; }
    const T& operator()(int i, int j) const { return entries_[place(i, j)]; }

private:
    static constexpr std::size_t place(int i, int j)
    {
        const int low = i < j ? i : j, high = i < j ? j : i;
        return static_cast<std::size_t>(high * (high + 1) / 2 + low);
    }

    std::array<T, static_cast<std::size_t>(N) * (N + 1) / 2> entries_;
};

} // namespace taut::impl
