// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <taut/impl/core/symbolic/cons_table.hpp>
#include <taut/impl/core/symbolic/node.hpp>

namespace taut::impl
{

/// A hash-consed DAG of scalar operations: equal operations on equal operands are one node, so that a value which
/// looks exponential when written out as a tree stays linear. Nodes are only ever appended, each after its operands:
/// creation order is a topological order, and every pass over the graph is a plain loop, never a recursion.
///
/// Constants are interned by their bits; variables, stores and loops are never shared.
class graph
{
public:
    /// Node 0 is the double constant 0: a value-initialised sym is zero, as a value-initialised double is.
    graph() { constant(0.0); }

    std::size_t size() const noexcept { return nodes_.size(); }

    /// Throws tape_error for a number that is not on this tape: a sym that never got a value, or another tape's.
    const node& operator[](node_id id) const
    {
        if (id < 0 || static_cast<std::size_t>(id) >= nodes_.size())
            refuse("a sym has no value on this tape: it was never initialised, or belongs to another tape");
        return nodes_[static_cast<std::size_t>(id)];
    }

    /// The number of the node, appended if the tape has no equal one.
    node_id intern(const node& n) { return table_.find_or_append(nodes_, n); }

    template <class T>
    node_id constant(T value)
    {
        return intern({.op = opcode::constant, .type = scalar_type_of<T>, .payload = to_bits(value)});
    }

    /// The type of constants of sym<double>: f64 unless it was chosen otherwise.
    void constants_in(scalar_type real) noexcept { real_ = real; }
    node_id real_constant(double value)
    {
        return real_ == scalar_type::f32 ? constant(static_cast<float>(value)) : constant(value);
    }

    /// A new independent variable, equal to no other.
    node_id variable(scalar_type type) { return intern({.op = opcode::variable, .type = type, .payload = serial_++}); }

    /// Element `at` of pointer argument `argument`, as of now: a later store to the argument makes a later load a
    /// different node. Inside a loop a new load stays there (it may be out of bounds for an empty loop).
    /// One that was loaded before the loop, or in a loop around it, is shared.
    node_id load(std::uint32_t argument, scalar_type type, node_id at)
    {
        node n{.op = opcode::load, .type = type, .operands = {at, no_node, no_node}};
        n.payload = (std::uint64_t{epoch(argument)} << 32) | argument;
        for (std::size_t depth = 0; depth < loops_.size(); ++depth)
        {
            if (const node_id found = table_.find(nodes_, n); found != no_node) return found;
            n.operands[1] = loops_[depth];
        }
        return intern(n);
    }

    /// Writes `value` to element `at`. Stores keep their order and are the roots of the kernel.
    void store(std::uint32_t argument, node_id at, node_id value)
    {
        if (!loops_.empty()) refuse("a store inside of sum_over: return the summand instead");
        // appended, not interned: writing the same value twice is two stores
        const node n{.op = opcode::store,
                     .type = (*this)[value].type,
                     .operands = {at, value, no_node},
                     .payload = (std::uint64_t{epoch(argument)} << 32) | argument};
        nodes_.push_back(n);
        stores_.push_back(static_cast<node_id>(nodes_.size() - 1));
        ++epochs_[argument];
    }

    std::span<const node_id> stores() const noexcept { return stores_; }

    /// Enters the body of a loop and returns its index node.
    node_id open_loop()
    {
        const node_id outer = loops_.empty() ? no_node : loops_.back();
        loops_.push_back(intern({.op = opcode::loop_index,
                                 .type = scalar_type::i32,
                                 .operands = {outer, no_node, no_node},
                                 .payload = serial_++}));
        return loops_.back();
    }

    void close_loop() noexcept { loops_.pop_back(); }

    /// Throws tape_error.
    [[noreturn]] static void refuse(const char* why);

private:
    std::uint32_t epoch(std::uint32_t argument)
    {
        if (argument >= epochs_.size()) epochs_.resize(argument + 1, 0);
        return epochs_[argument];
    }

    std::vector<node> nodes_;
    cons_table table_;
    std::vector<node_id> stores_;
    std::vector<std::uint32_t> epochs_; // stores so far, by argument
    std::vector<node_id> loops_;        // index nodes of the open loops, outermost first
    std::uint64_t serial_ = 0;
    scalar_type real_ = scalar_type::f64;
};

} // namespace taut::impl
