// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <taut/impl/core/symbolic/graph.hpp>

namespace taut
{

struct binding;

} // namespace taut

namespace taut::impl
{

/// Values of nodes, as bits: the operations of a tape, each in its own precision. Products are not contracted with
/// sums, as they may be on a device. Throws tape_error for an unbound leaf, and for integer operations without a
/// result.
std::vector<std::uint64_t> evaluated(const graph& t, std::span<const node_id> roots, std::span<const binding> bindings);

} // namespace taut::impl
