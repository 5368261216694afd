// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>

#include <taut/impl/core/symbolic/node.hpp>

namespace taut::impl
{

// What operations mean on the host. Constant folding and the evaluator share it, so that a folded kernel and an
// evaluated tape cannot disagree. "No result" is std::nullopt: for what is no arithmetic, and for what the device
// leaves undefined.

/// Integer arithmetic of the device: it wraps around; a division without a result has none.
std::optional<idx> apply_integer(opcode op, idx a, idx b);

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
std::optional<std::uint64_t> apply(const node& n, scalar_type from, std::uint64_t a, std::uint64_t b, std::uint64_t c);

} // namespace taut::impl
