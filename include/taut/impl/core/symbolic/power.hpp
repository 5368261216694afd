// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/core/single.hpp>
#include <taut/impl/core/symbolic/build.hpp>

namespace taut::impl
{

/// x to a positive integer power by repeated squaring: about log2(n) products, each rounded once.
node_id integer_power(graph& t, node_id x, unsigned n);

/// x^(n / parts) for parts = 1, 2 or 3 and n > 0: powers of x times powers of a root, NaN for negative x unless parts
/// is 1, as pow is.
node_id rational_power(graph& t, node_id x, unsigned n, unsigned parts);

/// pow(x, e). Integers, halves and thirds up to 64 become products, square or cube roots and one reciprocal: exp and
/// log are what a device does slowest, and they stop PoCL from vectorising the kernel. Up to 64, for the error of the
/// products grows with the exponent. A third is what T(k / 3.0) rounds to; the cube root then has the exponent that
/// was meant.
node_id build_power(graph& t, node_id x, node_id e);

} // namespace taut::impl
