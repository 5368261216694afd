// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>

#include <taut/impl/core/symbolic/cons_table.hpp>

namespace taut::impl
{

node_id cons_table::find_or_append(std::vector<node>& nodes, const node& n)
{
    if (2 * (count_ + 1) > slots_.size()) grow(nodes);
    const std::size_t slot = probe(nodes, n);
    if (slots_[slot] == no_node)
    {
        nodes.push_back(n);
        slots_[slot] = static_cast<node_id>(nodes.size() - 1);
        ++count_;
    }
    return slots_[slot];
}

std::size_t cons_table::hash(const node& n) noexcept
{
    // Multiply and shift after each word: the operands of neighbouring nodes differ in their low bits only.
    std::uint64_t h =
        n.payload ^ (std::uint64_t{static_cast<std::uint8_t>(n.op)} << 8) ^ static_cast<std::uint8_t>(n.type);
    for (const node_id operand : n.operands)
    {
        h = (h ^ (h >> 29)) * 0x9e3779b97f4a7c15u;
        h ^= static_cast<std::uint32_t>(operand);
    }
    h *= 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(h ^ (h >> 32));
}

std::size_t cons_table::probe(const std::vector<node>& nodes, const node& n) const
{
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash(n) & mask;
    while (slots_[slot] != no_node && !(nodes[static_cast<std::size_t>(slots_[slot])] == n)) slot = (slot + 1) & mask;
    return slot;
}

void cons_table::grow(const std::vector<node>& nodes)
{
    const std::vector<node_id> old = std::move(slots_);
    slots_.assign(old.empty() ? 256 : 2 * old.size(), no_node);
    for (const node_id id : old)
        if (id != no_node) slots_[probe(nodes, nodes[static_cast<std::size_t>(id)])] = id;
}

} // namespace taut::impl
