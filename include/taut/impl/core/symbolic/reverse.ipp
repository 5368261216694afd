// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/symbolic/reverse.hpp>

namespace taut::impl
{

reverse_accumulation::reverse_accumulation(graph& t, node_id f, std::span<const node_id> x)
    : t_(t), adjoints_(static_cast<std::size_t>(std::max(f, highest(x)) + 1)), depends_(adjoints_.size(), false)
{
    // Forward: what depends on some x at all. Constants of the problem then cost nothing on the way back.
    std::vector<bool> is_x(adjoints_.size(), false);
    for (const node_id id : x) is_x[at(id)] = true;
    for (node_id id = 0; id <= f; ++id)
    {
        const node& n = t_[id];
        bool depends = is_x[at(id)];
        for (const node_id operand : n.operands) depends |= operand != no_node && depends_[at(operand)];
        // integers and booleans are locally constant
        depends_[at(id)] = depends && is_floating(n.type);
    }

    // Backward: an adjoint that nobody set is zero, and is not propagated. At an x the sweep stops.
    if (depends_[at(f)]) adjoints_[at(f)].value = constant_of(t_, t_[f].type, 1.0);
    for (node_id id = f; id >= 0; --id)
        if (depends_[at(id)] && adjoints_[at(id)].value != no_node && !is_x[at(id)]) propagate(id);
}

node_id reverse_accumulation::partial(node_id id)
{
    const adjoint& a = adjoints_[at(id)];
    return a.value == no_node ? no_node : masked(a);
}

node_id reverse_accumulation::number(node_id like, double value)
{
    return constant_of(t_, t_[like].type, value);
}

node_id reverse_accumulation::masked(const adjoint& a)
{
    if (a.mask == no_node) return a.value;
    return build(t_, opcode::select, t_[a.value].type, a.mask, a.value, number(a.value, 0.0));
}

void reverse_accumulation::accumulate(node_id operand, const adjoint& g, node_id factor)
{
    if (!depends_[at(operand)]) return;
    adjoint term = g;
    if (factor != no_node) term.value = make(opcode::mul, g.value, factor);

    adjoint& sum = adjoints_[at(operand)];
    if (sum.value == no_node)
        sum = term;
    else if (sum.mask == term.mask)
        sum.value = make(opcode::add, sum.value, term.value);
    else
    {
        // the zeros of one term must not meet the infinities of the other unmasked
        sum.value = make(opcode::add, masked(sum), masked(term));
        sum.mask = either(sum.mask, term.mask);
    }
}

node_id reverse_accumulation::either(node_id m, node_id n)
{
    if (m == no_node || n == no_node) return no_node;
    const node_id mask = boolean(opcode::logical_or, m, n);
    return is_constant(t_, mask) ? no_node : mask; // m or not m: everywhere
}

void reverse_accumulation::propagate(node_id id)
{
    const node n = t_[id]; // a copy: the tape grows below
    const adjoint g = adjoints_[at(id)];
    const auto [a, b, c] = n.operands;
    const auto minus = [&] { return adjoint{make(opcode::neg, g.value), g.mask}; };
    const auto one_over = [&](node_id x) { return make(opcode::div, number(x, 1.0), x); };

    switch (n.op)
    {
    case opcode::neg:
        accumulate(a, minus());
        break;
    case opcode::add:
        accumulate(a, g);
        accumulate(b, g);
        break;
    case opcode::sub:
        accumulate(a, g);
        accumulate(b, minus());
        break;
    case opcode::mul:
        accumulate(a, g, b);
        accumulate(b, g, a);
        break;
    case opcode::div:
    {
        // y = a / b: da = g / b, db = -y g / b. Written with 1 / b, which all quotients over the same b share: one
        // division for the whole gradient, at the price of one more rounding.
        const adjoint over_b{make(opcode::mul, g.value, one_over(b)), g.mask};
        accumulate(a, over_b);
        accumulate(b, over_b, make(opcode::neg, id));
        break;
    }
    case opcode::abs:
    {
        // d|x| = sign(x); at the kink it is 1, one of the subgradients
        const node_id negative = boolean(opcode::less, a, number(a, 0.0));
        accumulate(a, {build(t_, opcode::select, n.type, negative, minus().value, g.value), g.mask});
        break;
    }
    case opcode::floor:
        break;         // zero almost everywhere
    case opcode::sqrt: // dy/da = 1 / (2 y)
        accumulate(a, g, make(opcode::div, number(a, 0.5), id));
        break;
    case opcode::cbrt:
    case opcode::root3: // dy/da = 1 / (3 y^2)
        accumulate(a, g, make(opcode::div, number(a, 1.0 / 3), make(opcode::mul, id, id)));
        break;
    case opcode::exp:
        accumulate(a, g, id);
        break;
    case opcode::log:
        accumulate(a, g, one_over(a));
        break;
    case opcode::sin:
        accumulate(a, g, make(opcode::cos, a));
        break;
    case opcode::cos:
        accumulate(a, minus(), make(opcode::sin, a));
        break;
    case opcode::tan: // dy/da = 1 + y^2
        accumulate(a, g, make(opcode::add, number(a, 1.0), make(opcode::mul, id, id)));
        break;
    case opcode::atan: // dy/da = 1 / (1 + a^2)
        accumulate(a, g, one_over(make(opcode::add, number(a, 1.0), make(opcode::mul, a, a))));
        break;
    case opcode::pow: // b a^(b - 1), and not b y / a, which is NaN at a = 0
        if (depends_[at(a)])
            accumulate(a, g, make(opcode::mul, b, build_power(t_, a, make(opcode::sub, b, number(b, 1.0)))));
        if (depends_[at(b)]) accumulate(b, g, make(opcode::mul, id, make(opcode::log, a)));
        break;
    case opcode::select: // each branch where it is taken
        accumulate(b, {g.value, both(g.mask, a)});
        accumulate(c, {g.value, both(g.mask, boolean(opcode::logical_not, a))});
        break;
    case opcode::cast:
        accumulate(a, {build(t_, opcode::cast, t_[a].type, g.value), g.mask});
        break;
    case opcode::loop_sum:
        graph::refuse("cannot differentiate through sum_over");
    default:
        graph::refuse("cannot differentiate with respect to what a load or an index depends on");
    }
}

std::vector<node_id> reverse_sweep(graph& t, node_id f, std::span<const node_id> x)
{
    for (const node_id id : x) static_cast<void>(t[id]); // throws for a sym without a value
    reverse_accumulation sweep(t, f, x);
    std::vector<node_id> partials;
    partials.reserve(x.size());
    for (const node_id id : x) partials.push_back(sweep.partial(id));
    return partials;
}

} // namespace taut::impl
