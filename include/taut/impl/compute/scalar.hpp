// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include <taut/impl/compute/queue_state.hpp>
#include <taut/impl/core/types.hpp>
#include <taut/impl/symbolic/scalar_type.hpp>

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

/// Refuses double early on a device without it; the driver would only fail later and less clearly.
inline void require_fp64(const queue_state& state, scalar_type type, const std::string& operation)
{
    if (type == scalar_type::f64 && !state.device.has_fp64())
        state.fail(operation, "the device has no double precision (fp64); use float, or another device");
}
template <class T>
void require_fp64(const queue_state& state, const std::string& operation)
{
    if constexpr (std::same_as<std::remove_const_t<T>, double>) require_fp64(state, scalar_type::f64, operation);
}

} // namespace taut::impl
