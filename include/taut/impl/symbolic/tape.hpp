// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/error.hpp>
#include <taut/impl/symbolic/cons_table.hpp>
#include <taut/impl/symbolic/node.hpp>

namespace taut
{

/// A mistake in the use of traced values: no tape is current, a value left its loop, a derivative does not exist.
class tape_error : public error
{
public:
    using error::error;
};

class tape;

} // namespace taut

namespace taut::impl
{

/// The tape that operations of this thread go to. Set by tape_scope only.
inline thread_local constinit tape* current_tape = nullptr;

} // namespace taut::impl

namespace taut
{

/// A hash-consed DAG of scalar operations: equal operations on equal operands are one node, so that a value which
/// looks exponential when written out as a tree stays linear. Nodes are only ever appended, each after its operands:
/// creation order is a topological order, and every pass over the tape is a plain loop, never a recursion.
///
/// A tape belongs to the thread that records on it. Constants are interned by their bits; variables, stores and loops
/// are never shared.
class tape
{
public:
    /// Node 0 is the double constant 0: a value-initialised sym is zero, as a value-initialised double is.
    tape() { constant(0.0); }

    /// The calling thread's tape. Throws tape_error if there is no tape_scope.
    static tape& current()
    {
        if (!impl::current_tape)
            throw tape_error("no tape: a sym was used outside of a recording; create a taut::tape_scope first");
        return *impl::current_tape;
    }

    std::size_t size() const noexcept { return nodes_.size(); }

    /// Throws tape_error for a number that is not on this tape: a sym that never got a value, or another tape's.
    const impl::node& operator[](impl::node_id id) const
    {
        if (id < 0 || static_cast<std::size_t>(id) >= nodes_.size())
            throw tape_error("a sym has no value on this tape: it was never initialised, or belongs to another tape");
        return nodes_[static_cast<std::size_t>(id)];
    }

    /// The number of the node, appended if the tape has no equal one.
    impl::node_id intern(const impl::node& n) { return table_.find_or_append(nodes_, n); }

    template <class T>
    impl::node_id constant(T value)
    {
        return intern({.op = impl::opcode::constant, .type = impl::scalar_type_of<T>, .payload = impl::to_bits(value)});
    }

    /// The type of constants of sym<double>: f64 unless it was chosen otherwise.
    void constants_in(scalar_type real) noexcept { real_ = real; }
    impl::node_id real_constant(double value)
    {
        return real_ == scalar_type::f32 ? constant(static_cast<float>(value)) : constant(value);
    }

    /// A new independent variable, equal to no other.
    impl::node_id variable(scalar_type type)
    {
        return intern({.op = impl::opcode::variable, .type = type, .payload = serial_++});
    }

    /// Element `at` of pointer argument `argument`, as of now: a later store to the argument makes a later load a
    /// different node. Inside a loop a new load stays there (it may be out of bounds for an empty loop).
    /// One that was loaded before the loop, or in a loop around it, is shared.
    impl::node_id load(std::uint32_t argument, scalar_type type, impl::node_id at)
    {
        impl::node n{.op = impl::opcode::load, .type = type, .operands = {at, impl::no_node, impl::no_node}};
        n.payload = (std::uint64_t{epoch(argument)} << 32) | argument;
        for (std::size_t depth = 0; depth < loops_.size(); ++depth)
        {
            if (const impl::node_id found = table_.find(nodes_, n); found != impl::no_node) return found;
            n.operands[1] = loops_[depth];
        }
        return intern(n);
    }

    /// Writes `value` to element `at`. Stores keep their order and are the roots of the kernel.
    void store(std::uint32_t argument, impl::node_id at, impl::node_id value)
    {
        if (!loops_.empty()) throw tape_error("a store inside of sum_over: return the summand instead");
        // appended, not interned: writing the same value twice is two stores
        const impl::node n{.op = impl::opcode::store,
                           .type = (*this)[value].type,
                           .operands = {at, value, impl::no_node},
                           .payload = (std::uint64_t{epoch(argument)} << 32) | argument};
        nodes_.push_back(n);
        stores_.push_back(static_cast<impl::node_id>(nodes_.size() - 1));
        ++epochs_[argument];
    }

    std::span<const impl::node_id> stores() const noexcept { return stores_; }

    /// Enters the body of a loop and returns its index node.
    impl::node_id open_loop()
    {
        const impl::node_id outer = loops_.empty() ? impl::no_node : loops_.back();
        loops_.push_back(intern({.op = impl::opcode::loop_index,
                                 .type = scalar_type::i32,
                                 .operands = {outer, impl::no_node, impl::no_node},
                                 .payload = serial_++}));
        return loops_.back();
    }

    void close_loop() noexcept { loops_.pop_back(); }

private:
    std::uint32_t epoch(std::uint32_t argument)
    {
        if (argument >= epochs_.size()) epochs_.resize(argument + 1, 0);
        return epochs_[argument];
    }

    std::vector<impl::node> nodes_;
    impl::cons_table table_;
    std::vector<impl::node_id> stores_;
    std::vector<std::uint32_t> epochs_; // stores so far, by argument
    std::vector<impl::node_id> loops_;  // index nodes of the open loops, outermost first
    std::uint64_t serial_ = 0;
    scalar_type real_ = scalar_type::f64;
};

/// Makes a tape the calling thread's current one for the lifetime of the scope; scopes nest.
class tape_scope
{
public:
    explicit tape_scope(tape& t) noexcept : outer_(std::exchange(impl::current_tape, &t)) {}
    ~tape_scope() { impl::current_tape = outer_; }
    tape_scope(const tape_scope&) = delete;
    tape_scope& operator=(const tape_scope&) = delete;

private:
    tape* outer_;
};

} // namespace taut
