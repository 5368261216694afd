// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <taut/impl/core/symbolic/apply.hpp>
#include <taut/impl/core/symbolic/graph.hpp>

namespace taut::impl
{

inline bool is_constant(const graph& t, node_id id)
{
    return t[id].op == opcode::constant;
}

/// Is the node this very constant, bit for bit? (-0 is not 0.)
bool is_constant(const graph& t, node_id id, double value);

inline node_id constant_of(graph& t, scalar_type type, double value)
{
    return with_type(type, [&]<class T>(std::type_identity<T>) { return t.constant(static_cast<T>(value)); });
}

/// Is one the negation of the other? Only by construction: `x < y` and `y <= x` are both false for NaN.
bool are_opposite(const graph& t, node_id a, node_id b);

/// The node of an operation: folded, simplified, in a canonical order of operands, and shared. Every operation of a
/// sym, and every one that differentiation adds, comes through here.
node_id build(graph& t, opcode op, scalar_type type, node_id a, node_id b = no_node, node_id c = no_node);

/// The operation on constants, done now and in the operation's own precision: a float kernel sees the float result.
/// Functions fold with the host's library, which may differ from the device's in the last place.
std::optional<node_id> fold_constants(graph& t, const node& n);

/// Identities of IEEE arithmetic that hold bit for bit (NaN payloads aside): so x - 0 but not x + 0, which turns -0
/// into +0, and never x * 0. Nothing is reassociated.
std::optional<node_id> simplify_arithmetic(graph& t, const node& n);

/// Boolean algebra, and choices that are already made. It keeps the masks of differentiation short.
std::optional<node_id> simplify_logic(graph& t, const node& n);

/// Exactly commutative: the result is the same, bit for bit, so that a + b and b + a may be one node.
constexpr bool commutes(opcode op) noexcept
{
    return op == opcode::add || op == opcode::mul || op == opcode::equal || op == opcode::not_equal ||
           op == opcode::logical_and || op == opcode::logical_or;
}

/// The type that two operands share. A constant takes that of the other one. Throws tape_error where float meets
/// double.
scalar_type shared_type(graph& t, node_id& a, node_id& b);

} // namespace taut::impl
