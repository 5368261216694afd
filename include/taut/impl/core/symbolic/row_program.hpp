// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <taut/impl/core/symbolic/graph.hpp>
#include <taut/impl/core/symbolic/node.hpp>
#include <taut/recording.hpp>

namespace taut::impl
{

/// Numbers of the operations on rows. Pure operations of the tape have one a type; two or three that follow one
/// another are one operation where nothing else needs the values between them.
struct row_code
{
    enum inner : int
    {
        sum,
        difference,
        product
    };
    enum outer : int
    {
        plus,
        minus,
        from,
        times
    }; ///< of x and c: x + c, x - c, c - x, x c

    static constexpr int plain(opcode op, scalar_type type)
    {
        return (static_cast<int>(op) - static_cast<int>(opcode::neg)) * 4 + static_cast<int>(type);
    }
    /// The type of what is converted in place of the operation's own.
    static constexpr int cast(scalar_type from, scalar_type to)
    {
        return casts + 4 * static_cast<int>(from) + static_cast<int>(to);
    }
    /// x = a i b, then x o c.
    static constexpr int pair(inner i, outer o, scalar_type type)
    {
        return pairs + 2 * (4 * i + o) + (type == scalar_type::f64);
    }
    /// (a i b) o (c j d); o is plus, minus or times.
    static constexpr int join(inner i, inner j, outer o, scalar_type type)
    {
        return joins + 2 * (4 * (3 * i + j) + o) + (type == scalar_type::f64);
    }

    static constexpr int casts = 4 * (static_cast<int>(opcode::cast) - static_cast<int>(opcode::neg));
    static constexpr int pairs = casts + 16, joins = pairs + 24;
    static constexpr int index = joins + 72;                                            ///< d = the indices + uniform a
    static constexpr int copy = index + 1, load = copy + 2, store = load + 2;           ///< by size: 4 bytes, 8 bytes
    static constexpr int gather = store + 2, masked = gather + 2, scatter = masked + 2; ///< the same
    static constexpr int loop = scatter + 2;                                            ///< by type
    static constexpr int count = loop + 3;
};

/// One operation on rows. `rows` are numbers of rows, the result first, but for
/// load: d, argument, uniform offset; store: value, argument, uniform offset (both at the index itself plus the
/// offset); gather: d, index, argument, uniform offset; masked: the same, and the row of the mask; scatter: value,
/// index, argument; loop: sum, begin, end, summand, counter, mask, mask of the loop around it or -1; its body are the
/// `body` operations that follow.
struct row_operation
{
    int code = 0;
    int body = 0;
    std::array<int, 7> rows{-1, -1, -1, -1, -1, -1, -1};
};

/// A recording as a program for the host: each operation computes a row, the values of one node for a block of indices.
/// Rows are scratch memory, taken again when their value is not needed any more. What is the same for all indices is
/// computed once a launch; what lies in memory one index after the other is a row there.
///
/// Pure: host/row_launch.hpp runs it.
struct row_program
{
    /// A value that is the same for all indices, or that is the index plus such a value (then: at index 0). Operands
    /// are numbers of uniforms; loads and arguments have their position as payload.
    struct uniform
    {
        int to;
        node what;
        scalar_type from; ///< type of operand 0
    };
    /// A row that is argument[index + uniform offset].
    struct alias
    {
        int row;
        std::size_t argument;
        int offset;
        node_id store; ///< that writes it; of one that is read: no_node
    };
    /// A row that has a uniform in all places.
    struct splat
    {
        int row, uniform;
        scalar_type type;
    };

    static constexpr std::size_t ahead = 2;

    row_program(const graph& t, std::vector<kernel_argument> arguments);

    std::vector<kernel_argument> arguments;
    std::vector<std::uint64_t> values; ///< of uniforms; those of constants are there already
    std::vector<uniform> uniforms;     ///< in the order of their computation
    std::vector<alias> aliases;        ///< in the order of the stores
    std::vector<splat> splats;
    std::vector<row_operation> code;  ///< and `ahead` more, which are read and not run
    std::vector<std::uint8_t> widths; ///< bytes of an element, by row
};

} // namespace taut::impl
