// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace taut::io::impl
{

/// The number whose bytes stand there in the given order.
template <class T>
T load(const char* at, std::endian order)
{
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), at, sizeof(T));
    if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

/// Writes the bytes of a number in the given order.
template <class T>
void store(char* to, T x, std::endian order)
{
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(x);
    if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    std::memcpy(to, bytes.data(), sizeof(T));
}

} // namespace taut::io::impl
