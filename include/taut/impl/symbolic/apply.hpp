// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>

#include <taut/impl/symbolic/node.hpp>

namespace taut::impl
{

// What operations mean on the host. Constant folding and the evaluator share it, so that a folded kernel and an
// evaluated tape cannot disagree. "No result" is std::nullopt: for what is no arithmetic, and for what the device
// leaves undefined.

/// Integer arithmetic of the device: it wraps around; a division without a result has none.
inline std::optional<idx> apply_integer(opcode op, idx a, idx b)
{
    // through unsigned numbers, for overflow of signed ones is undefined in C++
    const auto ua = static_cast<std::uint32_t>(a);
    const auto ub = static_cast<std::uint32_t>(b);
    const bool divides = b != 0 && !(a == std::numeric_limits<idx>::min() && b == -1);
    switch (op)
    {
    case opcode::neg:
        return static_cast<idx>(0u - ua);
    case opcode::add:
        return static_cast<idx>(ua + ub);
    case opcode::sub:
        return static_cast<idx>(ua - ub);
    case opcode::mul:
        return static_cast<idx>(ua * ub);
    case opcode::div:
        return divides ? std::optional(a / b) : std::nullopt;
    case opcode::rem:
        return divides ? std::optional(a % b) : std::nullopt;
    default:
        return std::nullopt;
    }
}

/// One floating-point operation in the precision of its type: T is float or double, never a wider intermediate.
template <class T>
std::optional<T> apply_floating(opcode op, T a, T b)
{
    switch (op)
    {
    case opcode::neg:
        return -a;
    case opcode::add:
        return a + b;
    case opcode::sub:
        return a - b;
    case opcode::mul:
        return a * b;
    case opcode::div:
        return a / b;
    case opcode::abs:
        return std::abs(a);
    case opcode::floor:
        return std::floor(a);
    case opcode::sqrt:
        return std::sqrt(a);
    case opcode::cbrt:
        return std::cbrt(a);
    case opcode::root3:
        return a < 0 ? std::numeric_limits<T>::quiet_NaN() : std::cbrt(a);
    case opcode::exp:
        return std::exp(a);
    case opcode::log:
        return std::log(a);
    case opcode::sin:
        return std::sin(a);
    case opcode::cos:
        return std::cos(a);
    case opcode::tan:
        return std::tan(a);
    case opcode::atan:
        return std::atan(a);
    case opcode::pow:
        return std::pow(a, b);
    default:
        return std::nullopt;
    }
}

/// Comparisons as in C: with NaN all are false but not_equal.
template <class T>
std::optional<bool> apply_comparison(opcode op, T a, T b)
{
    switch (op)
    {
    case opcode::less:
        return a < b;
    case opcode::less_equal:
        return a <= b;
    case opcode::equal:
        return a == b;
    case opcode::not_equal:
        return a != b;
    default:
        return std::nullopt;
    }
}

/// A conversion as the device does it: it truncates towards zero. Out of range has no result.
template <class To, class From>
std::optional<To> apply_cast(From value)
{
    if constexpr (std::is_floating_point_v<From> && std::is_same_v<To, idx>)
    {
        const double wide = value;
        if (!(wide > -2147483649.0 && wide < 2147483648.0)) return std::nullopt;
    }
    return static_cast<To>(value);
}

/// The value of a pure operation on the bits of its operands; `from` is the type of the compared or converted operand.
/// Nothing for operations that are not pure, and for those that the device leaves undefined.
inline std::optional<std::uint64_t> apply(const node& n, scalar_type from, std::uint64_t a, std::uint64_t b,
                                          std::uint64_t c)
{
    // the operations whose result has another type than their operands come first
    const auto bits = [](auto result) -> std::optional<std::uint64_t>
    { return result ? std::optional(to_bits(*result)) : std::nullopt; };

    switch (n.op)
    {
    case opcode::select:
        return a != 0 ? b : c;
    case opcode::logical_not:
        return a ^ 1u;
    case opcode::logical_and:
        return a & b;
    case opcode::logical_or:
        return a | b;
    case opcode::less:
    case opcode::less_equal:
    case opcode::equal:
    case opcode::not_equal:
        return with_type(from, [&]<class T>(std::type_identity<T>)
                         { return bits(apply_comparison(n.op, from_bits<T>(a), from_bits<T>(b))); });
    case opcode::cast:
        return with_type(from,
                         [&]<class From>(std::type_identity<From>)
                         {
                             return with_type(n.type, [&]<class To>(std::type_identity<To>)
                                              { return bits(apply_cast<To>(from_bits<From>(a))); });
                         });
    default:
        break;
    }
    switch (n.type)
    {
    case scalar_type::f32:
        return bits(apply_floating(n.op, from_bits<float>(a), from_bits<float>(b)));
    case scalar_type::f64:
        return bits(apply_floating(n.op, from_bits<double>(a), from_bits<double>(b)));
    case scalar_type::i32:
        return bits(apply_integer(n.op, from_bits<idx>(a), from_bits<idx>(b)));
    case scalar_type::boolean:
        break;
    }
    return std::nullopt;
}

} // namespace taut::impl
