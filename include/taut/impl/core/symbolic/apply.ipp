// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/symbolic/apply.hpp>

namespace taut::impl
{

std::optional<idx> apply_integer(opcode op, idx a, idx b)
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

std::optional<std::uint64_t> apply(const node& n, scalar_type from, std::uint64_t a, std::uint64_t b, std::uint64_t c)
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
