// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <unordered_map>

#include <taut/impl/core/symbolic/evaluate.hpp>
#include <taut/impl/core/symbolic/schedule.hpp>
#include <taut/symbolic.hpp>

namespace taut::impl
{

/// The operations of a tape, executed on the host.
class evaluator
{
public:
    evaluator(const graph& t, std::span<const binding> bindings) : tape_(t)
    {
        for (const binding& b : bindings) bound_.insert_or_assign(b.id, b.bits);
    }

    std::vector<std::uint64_t> operator()(std::span<const node_id> roots)
    {
        run(roots);
        std::vector<std::uint64_t> results;
        for (const node_id root : roots) results.push_back(value(root));
        return results;
    }

private:
    // Values travel as bits, as in the constants of the tape; each operation knows its type.
    std::uint64_t& value(node_id id) { return values_[static_cast<std::size_t>(id)]; }
    std::uint64_t operand(node_id id) { return id == no_node ? 0 : value(id); }

    void run(std::span<const node_id> roots)
    {
        values_.resize(tape_.size(), 0);
        // what lies below a bound node is not evaluated
        const schedule plan(tape_, roots, [this](node_id id) { return bound_.contains(id); });
        run(plan, plan.top());
    }

    void run(const schedule& plan, std::span<const node_id> ids)
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
                graph::refuse("evaluate: a variable, argument or load has no value bound to it");
            else if (const auto result = apply(n, tape_[a].type, operand(a), operand(b), operand(c)))
                value(id) = *result;
            else
                graph::refuse("evaluate: an integer division or conversion has no result");
        }
    }

    /// In the order of the device's loop, so that rounding agrees.
    std::uint64_t run_loop(const schedule& plan, const node& n)
    {
        const auto index_node = static_cast<node_id>(n.payload);
        const auto begin = from_bits<idx>(value(n.operands[0]));
        const auto end = from_bits<idx>(value(n.operands[1]));
        const node add{.op = opcode::add, .type = n.type};
        std::uint64_t sum = 0; // the bits of every type's zero
        for (idx k = begin; k < end; ++k)
        {
            value(index_node) = to_bits(k);
            run(plan, plan.body(index_node));
            sum = *apply(add, n.type, sum, value(n.operands[2]), 0);
        }
        return sum;
    }

    const graph& tape_;
    std::unordered_map<node_id, std::uint64_t> bound_;
    std::vector<std::uint64_t> values_;
};

std::vector<std::uint64_t> evaluated(const graph& t, std::span<const node_id> roots, std::span<const binding> bindings)
{
    return evaluator(t, bindings)(roots);
}

} // namespace taut::impl
