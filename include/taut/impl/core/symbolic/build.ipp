// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <taut/impl/core/symbolic/build.hpp>
#include <taut/symbolic.hpp>

namespace taut::impl
{

void graph::refuse(const char* why)
{
    throw tape_error(why);
}

bool is_constant(const graph& t, node_id id, double value)
{
    const node& n = t[id];
    if (n.op != opcode::constant) return false;
    return with_type(n.type,
                     [&]<class T>(std::type_identity<T>) { return n.payload == to_bits(static_cast<T>(value)); });
}

bool are_opposite(const graph& t, node_id a, node_id b)
{
    return (t[a].op == opcode::logical_not && t[a].operands[0] == b) ||
           (t[b].op == opcode::logical_not && t[b].operands[0] == a);
}

std::optional<node_id> fold_constants(graph& t, const node& n)
{
    std::array<std::uint64_t, 3> bits{};
    for (std::size_t k = 0; k < 3; ++k)
    {
        if (n.operands[k] == no_node) continue;
        const node& operand = t[n.operands[k]];
        if (operand.op != opcode::constant) return std::nullopt;
        bits[k] = operand.payload;
    }
    const auto value = apply(n, t[n.operands[0]].type, bits[0], bits[1], bits[2]);
    if (!value) return std::nullopt; // 1 / 0 of integers: leave it to the device
    return t.intern({.op = opcode::constant, .type = n.type, .payload = *value});
}

std::optional<node_id> simplify_arithmetic(graph& t, const node& n)
{
    const auto [a, b, c] = n.operands;
    const bool integer = n.type == scalar_type::i32;
    switch (n.op)
    {
    case opcode::neg:
        if (t[a].op == opcode::neg) return t[a].operands[0];
        break;
    case opcode::add:
        // -0 is the neutral element: x + -0 == x for every x, and 0 + -0 == 0
        if (is_constant(t, b, -0.0)) return a;
        if (is_constant(t, a, -0.0)) return b;
        // x + -y and x - y are one operation by definition
        if (t[b].op == opcode::neg) return build(t, opcode::sub, n.type, a, t[b].operands[0]);
        if (t[a].op == opcode::neg) return build(t, opcode::sub, n.type, b, t[a].operands[0]);
        break;
    case opcode::sub:
        if (is_constant(t, b, 0.0)) return a;
        if (t[b].op == opcode::neg) return build(t, opcode::add, n.type, a, t[b].operands[0]);
        break;
    case opcode::mul:
        if (is_constant(t, b, 1.0)) return a;
        if (is_constant(t, a, 1.0)) return b;
        if (is_constant(t, b, -1.0)) return build(t, opcode::neg, n.type, a);
        if (is_constant(t, a, -1.0)) return build(t, opcode::neg, n.type, b);
        // signs multiply apart from the magnitude, so both cancel before rounding
        if (t[a].op == opcode::neg && t[b].op == opcode::neg)
            return build(t, opcode::mul, n.type, t[a].operands[0], t[b].operands[0]);
        if (integer && (is_constant(t, a, 0.0) || is_constant(t, b, 0.0))) return constant_of(t, n.type, 0.0);
        break;
    case opcode::div:
        // not x / c = x * (1 / c): that rounds twice
        if (is_constant(t, b, 1.0)) return a;
        break;
    case opcode::cast:
        if (t[a].type == n.type) return a;
        // widening is exact, so narrowing back gives the original
        if (t[a].op == opcode::cast && t[a].type == scalar_type::f64 && t[t[a].operands[0]].type == n.type)
            return t[a].operands[0];
        break;
    default:
        break;
    }
    return std::nullopt;
}

std::optional<node_id> simplify_logic(graph& t, const node& n)
{
    const auto [a, b, c] = n.operands;
    switch (n.op)
    {
    case opcode::logical_not:
        if (t[a].op == opcode::logical_not) return t[a].operands[0];
        break;
    case opcode::logical_and:
    case opcode::logical_or:
    {
        const bool absorbing = n.op == opcode::logical_or; // x or true is true, x and false is false
        if (a == b) return a;
        if (are_opposite(t, a, b)) return t.constant(absorbing);
        if (is_constant(t, a)) return (t[a].payload != 0) == absorbing ? a : b;
        if (is_constant(t, b)) return (t[b].payload != 0) == absorbing ? b : a;
        break;
    }
    case opcode::select:
        if (is_constant(t, a)) return t[a].payload != 0 ? b : c;
        if (b == c) return b;
        // without negations, a choice and its opposite share their condition
        if (t[a].op == opcode::logical_not) return build(t, opcode::select, n.type, t[a].operands[0], c, b);
        // a choice inside of the same choice is already made
        if (t[b].op == opcode::select && t[b].operands[0] == a)
            return build(t, opcode::select, n.type, a, t[b].operands[1], c);
        if (t[c].op == opcode::select && t[c].operands[0] == a)
            return build(t, opcode::select, n.type, a, b, t[c].operands[2]);
        break;
    default:
        break;
    }
    return std::nullopt;
}

node_id build(graph& t, opcode op, scalar_type type, node_id a, node_id b, node_id c)
{
    node n{.op = op, .type = type, .operands = {a, b, c}};
    if (const auto folded = fold_constants(t, n)) return *folded;
    if (const auto simple =
            type == scalar_type::boolean || op == opcode::select ? simplify_logic(t, n) : simplify_arithmetic(t, n))
        return *simple;
    if (commutes(op) && n.operands[0] > n.operands[1]) std::swap(n.operands[0], n.operands[1]);
    return t.intern(n);
}

scalar_type shared_type(graph& t, node_id& a, node_id& b)
{
    if (t[a].type == t[b].type) return t[a].type;
    if (is_constant(t, b))
        b = build(t, opcode::cast, t[a].type, b);
    else if (is_constant(t, a))
        a = build(t, opcode::cast, t[b].type, a);
    else
        graph::refuse("float and double meet in one operation; cast() one of them");
    return t[a].type;
}

} // namespace taut::impl
