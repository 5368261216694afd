// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>

namespace taut::impl
{

/// The number of single precision that is nearest to x, ties to even; infinite beyond its range.
/// By the bits of x, not by double(float(x)): GCC 12 at -O2 drops that pair of conversions from loops over the
/// coordinates of a point, so that numbers come out as they went in.
inline double in_single(double x)
{
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const std::uint64_t magnitude = bits & ~(std::uint64_t(1) << 63);
    constexpr std::uint64_t exponent_of_one = 1023, infinite = 0x7ff0'0000'0000'0000;
    if (magnitude >= infinite) return x;           // of infinity, NaN
    if (magnitude < (exponent_of_one - 126) << 52) // a subnormal float: a whole number of 2^-149
    {
        constexpr double shift = 0x1.8p-97; // its last digit is 2^-149
        const double rounded = (std::bit_cast<double>(magnitude) + shift) - shift;
        return std::bit_cast<double>(std::bit_cast<std::uint64_t>(rounded) | (bits ^ magnitude));
    }
    std::uint64_t rounded = magnitude + 0x0fff'ffff + ((magnitude >> 29) & 1); // half of the last digit that stays
    rounded &= ~std::uint64_t(0x1fff'ffff);
    if (rounded >= (exponent_of_one + 128) << 52) rounded = infinite;
    return std::bit_cast<double>(rounded | (bits ^ magnitude));
}

} // namespace taut::impl
