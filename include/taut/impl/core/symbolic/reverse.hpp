// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/core/symbolic/power.hpp>

namespace taut::impl
{

/// Reverse accumulation over one tape (Griewank and Walther, Evaluating Derivatives, chapter 3).
///
///   node    y = op(a, b)             of the forward pass
///   adjoint g = df / dy              known once all users of y are done, hence the reverse order
///   rule    da += g dy/da            one line per operation in propagate()
///
/// The adjoint of a node is kept as a value and a mask (where in the domain the
/// node was used at all) and means `mask ? value : 0`. Only at a sum of different masks, and at the end, does it become
/// a select: so a partial derivative is multiplied inside of the select, and an infinite one of an untaken branch
/// does not turn its zero into NaN.
class reverse_accumulation
{
public:
    reverse_accumulation(graph& t, node_id f, std::span<const node_id> x);

    /// The derivative by node `id`, or no_node if it is zero everywhere.
    node_id partial(node_id id);

private:
    struct adjoint
    {
        node_id value = no_node; // none: zero everywhere
        node_id mask = no_node;  // none: everywhere
    };

    static std::size_t at(node_id id) noexcept { return static_cast<std::size_t>(id); }

    static node_id highest(std::span<const node_id> x) noexcept
    {
        return x.empty() ? 0 : *std::max_element(x.begin(), x.end());
    }

    // Nodes in the type of their first operand, constants in the type of another node, and logic.
    node_id make(opcode op, node_id a, node_id b = no_node) { return build(t_, op, t_[a].type, a, b); }
    node_id number(node_id like, double value);
    node_id boolean(opcode op, node_id a, node_id b = no_node) { return build(t_, op, scalar_type::boolean, a, b); }

    /// The adjoint as one value.
    node_id masked(const adjoint& a);

    /// Adds value * factor, where mask holds, to the adjoint of an operand; a factor of none is 1.
    void accumulate(node_id operand, const adjoint& g, node_id factor = no_node);

    /// Disjunction of two conditions; none stands for everywhere.
    node_id either(node_id m, node_id n);

    /// Conjunction of two conditions.
    node_id both(node_id m, node_id n) { return m == no_node ? n : boolean(opcode::logical_and, m, n); }

    /// Adds the share of a node's operands to their adjoints. `id` itself serves as the value y where a rule needs it.
    void propagate(node_id id);

    graph& t_;
    std::vector<adjoint> adjoints_;
    std::vector<bool> depends_;
};

/// The derivatives of node f by the nodes x, each treated as independent of the others; no_node for zero.
std::vector<node_id> reverse_sweep(graph& t, node_id f, std::span<const node_id> x);

} // namespace taut::impl
