// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <type_traits>

#include <taut/types.hpp>

namespace taut::impl
{

/// A number that has the same size and meaning on the host and on every device: float, double, and the fixed-width
/// integers of 32 and 64 bits. Structs and vectors do not cross the boundary.
template <class T>
concept device_scalar = std::same_as<T, float> || std::same_as<T, double> ||
    (std::integral<T> && !std::same_as<T, bool> && (sizeof(T) == 4 || sizeof(T) == 8));

/// The OpenCL C name of a device scalar.
template <device_scalar T>
constexpr const char* cl_name()
{
    if constexpr (std::same_as<T, float>)
        return "float";
    else if constexpr (std::same_as<T, double>)
        return "double";
    else if constexpr (sizeof(T) == 4)
        return std::signed_integral<T> ? "int" : "uint";
    else
        return std::signed_integral<T> ? "long" : "ulong";
}

/// A type of numbers in the memory of a device.
struct number_type
{
    const char* name; ///< in OpenCL C
    std::size_t bytes;
};

template <device_scalar T>
inline constexpr number_type number_type_of{cl_name<T>(), sizeof(T)};

} // namespace taut::impl
