// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <taut/impl/core/symbolic/power.hpp>

namespace taut::impl
{

node_id integer_power(graph& t, node_id x, unsigned n)
{
    const scalar_type type = t[x].type;
    node_id result = no_node;
    for (node_id square = x;; square = build(t, opcode::mul, type, square, square))
    {
        if (n & 1u) result = result == no_node ? square : build(t, opcode::mul, type, result, square);
        if ((n >>= 1) == 0) return result;
    }
}

node_id rational_power(graph& t, node_id x, unsigned n, unsigned parts)
{
    const scalar_type type = t[x].type;
    node_id result = no_node;
    if (n >= parts) result = integer_power(t, x, n / parts);
    if (n % parts != 0)
    {
        const node_id root = build(t, parts == 2 ? opcode::sqrt : opcode::root3, type, x);
        const node_id part = integer_power(t, root, n % parts);
        result = result == no_node ? part : build(t, opcode::mul, type, result, part);
    }
    return result;
}

node_id build_power(graph& t, node_id x, node_id e)
{
    const scalar_type type = t[x].type;
    if (is_constant(t, x) || !is_constant(t, e)) return build(t, opcode::pow, type, x, e);

    const double exponent = type == scalar_type::f32 ? from_bits<float>(t[e].payload) : from_bits<double>(t[e].payload);
    const double magnitude = std::abs(exponent);
    if (magnitude == 0) return constant_of(t, type, 1.0); // also for NaN and 0, as std::pow
    if (!(magnitude <= 64)) return build(t, opcode::pow, type, x, e);

    const auto is_ratio = [&](double n, double parts)
    {
        const double ratio = n / parts;
        return magnitude == (type == scalar_type::f32 ? in_single(ratio) : ratio);
    };
    for (const unsigned parts : {1u, 2u, 3u})
    {
        const double n = std::round(magnitude * parts);
        if (n == 0 || !is_ratio(n, parts)) continue;
        const node_id power = rational_power(t, x, static_cast<unsigned>(n), parts);
        return exponent > 0 ? power : build(t, opcode::div, type, constant_of(t, type, 1.0), power);
    }
    return build(t, opcode::pow, type, x, e);
}

} // namespace taut::impl
