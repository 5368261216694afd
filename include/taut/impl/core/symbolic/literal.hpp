// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include <taut/impl/core/symbolic/scalar_type.hpp>

namespace taut::impl
{

/// The parts one after the other. Not operator+, whose insertions in front g++ 12 warns about without need.
template <class... Parts>
std::string concat(const Parts&... parts)
{
    std::string text;
    (text.append(std::string_view(parts)), ...);
    return text;
}

/// A letter and a number, as t12 and i0 in the text of a kernel.
inline std::string numbered(std::string_view letter, std::uint64_t number)
{
    return concat(letter, std::to_string(number));
}

/// The OpenCL C literal that reads back as the same bits (of a NaN: as a NaN). Floating-point numbers are hexadecimal,
/// with the suffix of their type; negative ones are in parentheses. Independent of the locale.
template <class T>
std::string literal(T value)
{
    if constexpr (std::is_same_v<T, bool>)
        return value ? "true" : "false";
    else if constexpr (std::is_same_v<T, idx>)
    {
        // There are no negative literals, and 2147483648 would be a long.
        if (value == std::numeric_limits<idx>::min()) return "(-2147483647 - 1)";
        return value < 0 ? concat("(", std::to_string(value), ")") : std::to_string(value);
    }
    else
    {
        constexpr bool is_float = std::is_same_v<T, float>;
        if (std::isnan(value)) return is_float ? "NAN" : "((double)NAN)";
        std::string text;
        if (std::isinf(value))
            text = is_float ? "INFINITY" : "(double)INFINITY"; // the macro is a float
        else
        {
            char digits[40];
            const auto end =
                std::to_chars(std::begin(digits), std::end(digits), std::abs(value), std::chars_format::hex);
            text = concat("0x", std::string_view(digits, end.ptr), is_float ? "f" : "");
        }
        return std::signbit(value) ? concat("(-", text, ")") : text;
    }
}

/// The literal of a constant node.
inline std::string literal(scalar_type type, std::uint64_t bits)
{
    return with_type(type, [&]<class T>(std::type_identity<T>) { return literal(from_bits<T>(bits)); });
}

} // namespace taut::impl
