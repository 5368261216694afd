// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <unordered_map>
#include <vector>

#include <taut/impl/core/symbolic/graph.hpp>

namespace taut::impl
{

/// The nodes that some roots need, in the order of execution: creation order, except that whatever varies with a
/// loop's index waits for its loop. Both the emitter and the host evaluator walk it.
class schedule
{
public:
    schedule(const graph& t, std::span<const node_id> roots) : schedule(t, roots, [](node_id) { return false; }) {}

    /// is_known(id): the node's value is given, so that its operands are not needed for it.
    template <class Known>
    schedule(const graph& t, std::span<const node_id> roots, Known is_known) : tape_(t)
    {
        // Operands are older than their users: one sweep down marks all that is needed.
        node_id last = no_node;
        for (const node_id root : roots) last = std::max(last, (static_cast<void>(t[root]), root));
        std::vector<bool> needed(static_cast<std::size_t>(last + 1), false);
        uses_.assign(needed.size(), 0);
        for (const node_id root : roots) needed[static_cast<std::size_t>(root)] = true;
        for (node_id id = last; id >= 0; --id)
            if (needed[static_cast<std::size_t>(id)] && !is_known(id))
                for (const node_id operand : t[id].operands)
                    if (operand != no_node)
                    {
                        needed[static_cast<std::size_t>(operand)] = true;
                        ++uses_[static_cast<std::size_t>(operand)];
                    }

        // Up again: by then the regions of all operands are known.
        regions_.assign(needed.size(), no_node);
        for (node_id id = 0; id <= last; ++id)
            if (needed[static_cast<std::size_t>(id)]) place(id, is_known(id));
        for (const node_id root : roots)
            if (region(root) != no_node) throw_leak();
    }

    /// The nodes outside of all loops. A loop_sum stands where its loop runs.
    std::span<const node_id> top() const noexcept { return top_; }

    /// Number of nodes of the schedule have the node as an operand.
    int uses(node_id id) const { return uses_[static_cast<std::size_t>(id)]; }

    /// The index node of the innermost loop that the node varies with, or no_node.
    node_id region(node_id id) const { return regions_[static_cast<std::size_t>(id)]; }

    /// The nodes inside of the loop with this index node.
    std::span<const node_id> body(node_id loop_index) const
    {
        const auto found = bodies_.find(loop_index);
        return found == bodies_.end() ? std::span<const node_id>() : std::span<const node_id>(found->second);
    }

private:
    node_id parent(node_id loop_index) const { return tape_[loop_index].operands[0]; }

    /// Finds the innermost loop that a node varies with, and appends the node to that loop's body. The loops of its
    /// operands must be nested in one another: otherwise a value has left its loop.
    void place(node_id id, bool is_known)
    {
        const node& n = tape_[id];
        node_id& innermost = regions_[static_cast<std::size_t>(id)];
        if (n.op == opcode::loop_index)
        {
            innermost = id;
            return; // declared by the loop itself
        }
        if (is_known)
        {
            top_.push_back(id);
            return;
        }
        // A loop_sum stays where it was written, inside of its parent; its own index must not show outside of it.
        const node_id own = n.op == opcode::loop_sum ? static_cast<node_id>(n.payload) : no_node;
        if (own != no_node) innermost = parent(own);
        for (const node_id operand : n.operands)
        {
            if (operand == no_node) continue;
            node_id r = region(operand);
            if (own != no_node && r == own && operand == n.operands[2]) continue; // the summand may vary with its loop
            if (encloses(innermost, r))
                innermost = r;
            else if (!encloses(r, innermost))
                throw_leak();
        }
        if (own != no_node && innermost != parent(own)) throw_leak();
        (innermost == no_node ? top_ : bodies_[innermost]).push_back(id);
    }

    /// Is `inner` the loop `outer`, or inside of it? No loop at all encloses everything.
    bool encloses(node_id outer, node_id inner) const
    {
        for (; inner != no_node; inner = parent(inner))
            if (inner == outer) return true;
        return outer == no_node;
    }

    [[noreturn]] static void throw_leak()
    {
        graph::refuse("a value that varies inside of sum_over is used outside of its loop");
    }

    const graph& tape_;
    std::vector<int> uses_;
    std::vector<node_id> regions_;
    std::vector<node_id> top_;
    std::unordered_map<node_id, std::vector<node_id>> bodies_;
};

} // namespace taut::impl
