// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include <taut/impl/core/symbolic/scalar_type.hpp>

namespace taut::impl
{

/// Operations of the nodes of a tape. Comparisons that are missing here are spelled with swapped operands.
enum class opcode : std::uint8_t
{
    // leaves
    constant,   ///< payload: the bits of the value
    variable,   ///< payload: its number; only evaluate() gives it a value
    argument,   ///< a scalar kernel argument; payload: its position
    global_id,  ///< payload: the dimension of the range
    loop_index, ///< payload: the number of the loop; operand 0: the index of the loop around it, if any
                // arithmetic
    neg,
    add,
    sub,
    mul,
    div,
    rem,
    // functions
    abs,
    floor,
    sqrt,
    cbrt,
    root3, ///< x^(1/3): cbrt where x >= 0, and NaN as pow() elsewhere
    exp,
    log,
    sin,
    cos,
    tan,
    atan,
    pow,
    // booleans
    less,
    less_equal,
    equal,
    not_equal,
    logical_not,
    logical_and,
    logical_or,
    // the rest
    select,   ///< operand 0 ? operand 1 : operand 2
    cast,     ///< operand 0 in another type
    load,     ///< operand 0: element number; operand 1: loop_index it must stay under, if any; payload: argument, epoch
    store,    ///< operand 0: element number; operand 1: value; payload: argument
    loop_sum, ///< operands: begin, end, summand; payload: the number of the loop
};

/// The number of a node; operands always have smaller numbers than their users, so creation order is topological.
using node_id = std::int32_t;

/// "No operand".
inline constexpr node_id no_node = -1;

/// One operation on the tape.
struct node
{
    opcode op{};
    scalar_type type{};
    std::array<node_id, 3> operands{no_node, no_node, no_node};
    std::uint64_t payload = 0;

    friend bool operator==(const node&, const node&) = default;
};

} // namespace taut::impl
