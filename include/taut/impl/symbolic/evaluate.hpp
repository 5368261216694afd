// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <unordered_map>
#include <vector>

#include <taut/impl/symbolic/schedule.hpp>
#include <taut/impl/symbolic/sym.hpp>

namespace taut::impl
{

/// A node and the value it takes: usually a variable, but any node may be replaced (a load, a kernel argument).
struct binding
{
    template <traceable T>
    binding(sym<T> x, T value) : id(x.id()), bits(impl::to_bits(value))
    {
    }

    node_id id;
    std::uint64_t bits;
};

/// Executes traced values on the host, each operation in its own precision: an oracle for kernels that needs no device.
/// Products are not contracted with sums, as they may be on a device. Loads need a binding: there is no memory.
class evaluator
{
public:
    explicit evaluator(const tape& t, std::span<const binding> bindings) : tape_(t)
    {
        for (const binding& b : bindings) bound_.insert_or_assign(b.id, b.bits);
    }

    /// The values of some outputs. Throws tape_error for an unbound leaf, and for integer operations without a result.
    template <traceable T>
    std::vector<T> operator()(std::span<const sym<T>> outputs)
    {
        std::vector<node_id> roots;
        for (const sym<T> output : outputs) roots.push_back(output.id());
        run(roots);
        std::vector<T> results;
        for (const node_id root : roots) results.push_back(impl::from_bits<T>(value(root)));
        return results;
    }

    /// The same for a comparison.
    bool operator()(sym_bool output)
    {
        const node_id root = output.id();
        run({&root, 1});
        return value(root) != 0;
    }

private:
    // Values travel as bits, as in the constants of the tape; each operation knows its type.
    std::uint64_t& value(node_id id) { return values_[static_cast<std::size_t>(id)]; }
    std::uint64_t operand(node_id id) { return id == no_node ? 0 : value(id); }

    void run(std::span<const node_id> roots)
    {
        values_.resize(tape_.size(), 0);
        // what lies below a bound node is not evaluated
        const impl::schedule plan(tape_, roots, [this](node_id id) { return bound_.contains(id); });
        run(plan, plan.top());
    }

    void run(const impl::schedule& plan, std::span<const node_id> ids)
    {
        for (const node_id id : ids)
        {
            const node& n = tape_[id];
            const auto [a, b, c] = n.operands;
            if (const auto found = bound_.find(id); found != bound_.end())
                value(id) = found->second;
            else if (n.op == opcode::constant)
                value(id) = n.payload;
            else if (n.op == opcode::loop_sum)
                value(id) = run_loop(plan, n);
            else if (const bool pure = a != no_node && n.op != opcode::load && n.op != opcode::store; !pure)
                throw tape_error("evaluate: a variable, argument or load has no value bound to it");
            else if (const auto result = impl::apply(n, tape_[a].type, operand(a), operand(b), operand(c)))
                value(id) = *result;
            else
                throw tape_error("evaluate: an integer division or conversion has no result");
        }
    }

    /// In the order of the device's loop, so that rounding agrees.
    std::uint64_t run_loop(const impl::schedule& plan, const node& n)
    {
        const auto index_node = static_cast<node_id>(n.payload);
        const auto begin = impl::from_bits<idx>(value(n.operands[0]));
        const auto end = impl::from_bits<idx>(value(n.operands[1]));
        const node add{.op = opcode::add, .type = n.type};
        std::uint64_t sum = 0; // the bits of every type's zero
        for (idx k = begin; k < end; ++k)
        {
            value(index_node) = impl::to_bits(k);
            run(plan, plan.body(index_node));
            sum = *impl::apply(add, n.type, sum, value(n.operands[2]), 0);
        }
        return sum;
    }

    const tape& tape_;
    std::unordered_map<node_id, std::uint64_t> bound_;
    std::vector<std::uint64_t> values_;
};

} // namespace taut::impl

namespace taut
{

/// Value of a traced expression of the current tape: evaluate(f, {{x, 2.0}, {y, 3.0}}).
template <impl::traceable T>
T evaluate(sym<T> f, std::initializer_list<impl::binding> bindings = {})
{
    return impl::evaluator(tape::current(), {bindings.begin(), bindings.size()})(std::span<const sym<T>>(&f, 1))
        .front();
}

/// Several values at once, for bindings that a program collected.
template <impl::traceable T>
std::vector<T> evaluate(const std::vector<sym<T>>& outputs, std::span<const impl::binding> bindings)
{
    return impl::evaluator(tape::current(), bindings)(std::span<const sym<T>>(outputs));
}

inline bool evaluate(sym_bool f, std::initializer_list<impl::binding> bindings = {})
{
    return impl::evaluator(tape::current(), {bindings.begin(), bindings.size()})(f);
}

} // namespace taut
