// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include <taut/types.hpp>

namespace taut::impl
{

/// Host types with a traced counterpart sym<T>.
template <class T>
concept traceable = std::same_as<T, float> || std::same_as<T, double> || std::same_as<T, idx>;

/// The scalar_type of a host type.
template <class T>
    requires(traceable<T> || std::same_as<T, bool>)
inline constexpr scalar_type scalar_type_of = std::same_as<T, float>    ? scalar_type::f32
                                              : std::same_as<T, double> ? scalar_type::f64
                                              : std::same_as<T, idx>    ? scalar_type::i32
                                                                        : scalar_type::boolean;

constexpr bool is_floating(scalar_type type) noexcept
{
    return type == scalar_type::f32 || type == scalar_type::f64;
}

/// The name of the type in OpenCL C.
constexpr std::string_view spelling(scalar_type type) noexcept
{
    constexpr std::string_view names[] = {"float", "double", "int", "bool"};
    return names[static_cast<int>(type)];
}

/// The size of one element of the type in device memory, in bytes.
constexpr std::size_t size_of(scalar_type type) noexcept
{
    return type == scalar_type::f64 ? 8 : 4;
}

/// Constants travel as bit patterns: literals then round-trip exactly, and -0, +0 and NaN stay apart.
template <class T>
constexpr std::uint64_t to_bits(T value) noexcept
{
    if constexpr (std::same_as<T, double>)
        return std::bit_cast<std::uint64_t>(value);
    else if constexpr (std::same_as<T, bool>)
        return value ? 1u : 0u;
    else
        return std::bit_cast<std::uint32_t>(value);
}

template <class T>
constexpr T from_bits(std::uint64_t bits) noexcept
{
    if constexpr (std::same_as<T, double>)
        return std::bit_cast<double>(bits);
    else if constexpr (std::same_as<T, bool>)
        return bits != 0;
    else
        return std::bit_cast<T>(static_cast<std::uint32_t>(bits));
}

/// Calls f(std::type_identity<T>{}) with the host type of a scalar_type.
template <class F>
constexpr decltype(auto) with_type(scalar_type type, F&& f)
{
    switch (type)
    {
    case scalar_type::f32:
        return f(std::type_identity<float>{});
    case scalar_type::f64:
        return f(std::type_identity<double>{});
    case scalar_type::i32:
        return f(std::type_identity<idx>{});
    case scalar_type::boolean:
        break;
    }
    return f(std::type_identity<bool>{});
}

} // namespace taut::impl
