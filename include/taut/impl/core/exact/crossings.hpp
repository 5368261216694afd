// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// True if r, known to lie on the line through p and q, is on the closed segment.
inline bool between(const vec2& p, const vec2& q, const vec2& r)
{
    return std::min(p.x, q.x) <= r.x && r.x <= std::max(p.x, q.x) && std::min(p.y, q.y) <= r.y &&
           r.y <= std::max(p.y, q.y);
}

/// True if the closed segments ab and cd have a common point; exact.
bool segments_meet(const vec2& a, const vec2& b, const vec2& c, const vec2& d);

/// True if segments ab and bc share more than b: c folds back over ab.
inline bool folds_back(const vec2& a, const vec2& b, const vec2& c)
{
    return orient2d(a, b, c) == 0 && (between(a, b, c) || between(b, c, a));
}

/// True if the images of two edges have a common point beyond a common end vertex.
bool edges_meet(const std::array<idx, 2>& e, const std::array<idx, 2>& f, std::span<const vec2> x);

/// A box with sides along the axes.
struct edge_box
{
    vec2 low, high;

    static edge_box of(const std::array<idx, 2>& edge, std::span<const vec2> x)
    {
        const vec2 &p = x[static_cast<std::size_t>(edge[0])], &q = x[static_cast<std::size_t>(edge[1])];
        return {glm::min(p, q), glm::max(p, q)};
    }

    bool meets(const edge_box& o) const
    {
        return low.x <= o.high.x && o.low.x <= high.x && low.y <= o.high.y && o.low.y <= high.y;
    }
    double distance(const edge_box& o) const
    {
        return glm::length(glm::max(vec2(0), glm::max(low - o.high, o.low - high)));
    }
};

/// A binary tree of boxes about edges: halves along the longer side of what a node holds. Of edges in groups, as the
/// borders of charts are, each group is a tree by itself, and the tree of all is one of groups.
class edge_tree
{
public:
    /// Edges with finite ends. groups: #groups + 1, where each begins, and none is empty; or nothing. Pairs of one
    /// group are left out.
    edge_tree(std::span<const std::array<idx, 2>> edges, std::span<const vec2> x, std::span<const idx> groups = {});

    /// Calls look(i, j), i < j, for each pair of edges whose boxes meet, until it returns false.
    template <class Look>
    void for_each_pair(Look&& look) const
    {
        const auto meet = [](const edge_box& a, const edge_box& b) { return a.meets(b); };
        if (!nodes_.empty()) visit(root_, root_, look, meet);
    }

    /// The same of pairs whose boxes are nearer than `reach`, which `look` may make smaller.
    template <class Look>
    void for_each_pair_within(const double& reach, Look&& look) const
    {
        const auto near = [&reach](const edge_box& a, const edge_box& b) { return a.distance(b) < reach; };
        if (!nodes_.empty()) visit(root_, root_, look, near);
    }

    /// Calls look(g, h) for each pair of groups whose boxes meet, until it returns false.
    template <class Look>
    void for_each_pair_of_groups(Look&& look) const
    {
        if (!nodes_.empty()) visit_groups(root_, root_, look);
    }

    /// The box of the group with this first edge.
    const edge_box& box_of_group(idx first_edge) const { return nodes_[u(first_edge)].bounds; }

    /// Calls look(i) for each edge of the group with this first edge whose box meets another one, until it returns
    /// false.
    template <class Look>
    void for_each_in_group(idx first_edge, const edge_box& box, Look&& look) const
    {
        visit_in(first_edge, box, look);
    }

private:
    static constexpr idx none = -1, leaf = 8;

    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    struct entry
    {
        edge_box bounds;
        idx number; // of the edge, or of the node that is the root of a group

        double centre(int side) const { return bounds.low[side] / 2 + bounds.high[side] / 2; }
    };

    struct node
    {
        edge_box bounds;
        idx first, last;               // of entries_, or of groups
        idx left = none, right = none; // none: a leaf
        idx group = none;              // that all are of; none: of several
    };

    /// Entries of a node.
    struct part
    {
        idx node, first, last, group;
    };

    static edge_box box_about(std::span<const entry> entries)
    {
        edge_box box = entries[0].bounds;
        for (const entry& e : entries)
        {
            box.low = glm::min(box.low, e.bounds.low);
            box.high = glm::max(box.high, e.bounds.high);
        }
        return box;
    }

    /// Makes the node of a part without what is below it.
    node& enclose(std::span<const entry> entries, const part& p)
    {
        const auto own = entries.subspan(u(p.first), u(p.last - p.first));
        return nodes_[u(p.node)] = {box_about(own), p.first, p.last, none, none, p.group};
    }

    /// Makes the node of a part of several entries, and the halves below it.
    /// least: entries of a leaf at most; where it is 1, entries have nodes
    std::pair<part, part> halve(std::span<entry> entries, idx least, const part& p);

    /// Builds trees at the same time; large ones are halved before, so that all threads have a share.
    void build_all(std::span<entry> entries, idx least, std::vector<part> parts);

    void build(std::span<entry> entries, idx least, const part& p);

    /// Looks at the pairs of an edge of node a and one of node b; a == b: at those within it.
    template <class Look, class Near>
    bool visit(idx a, idx b, Look& look, const Near& near) const
    {
        const node &m = nodes_[u(a)], &n = nodes_[u(b)];
        if ((m.group != none && m.group == n.group) || !near(m.bounds, n.bounds)) return true;
        if (m.left == none && n.left == none)
        {
            for (idx i = m.first; i < m.last; ++i)
                for (idx j = a == b ? i + 1 : n.first; j < n.last; ++j)
                {
                    const entry &e = entries_[u(i)], &f = entries_[u(j)];
                    if (near(e.bounds, f.bounds) &&
                        !look(u(std::min(e.number, f.number)), u(std::max(e.number, f.number))))
                        return false;
                }
            return true;
        }
        if (a == b)
            return visit(m.left, m.left, look, near) && visit(m.right, m.right, look, near) &&
                   visit(m.left, m.right, look, near);
        // The larger one is halved.
        if (n.left == none || (m.left != none && larger(m, n)))
            return visit(m.left, b, look, near) && visit(m.right, b, look, near);
        return visit(a, n.left, look, near) && visit(a, n.right, look, near);
    }

    static bool larger(const node& m, const node& n)
    {
        // Of several groups is more than of one.
        if ((m.group == none) != (n.group == none)) return m.group == none;
        return m.last - m.first >= n.last - n.first;
    }

    template <class Look>
    bool visit_in(idx a, const edge_box& window, Look& look) const
    {
        const node& m = nodes_[u(a)];
        if (!m.bounds.meets(window)) return true;
        if (m.left != none) return visit_in(m.left, window, look) && visit_in(m.right, window, look);
        for (idx i = m.first; i < m.last; ++i)
            if (entries_[u(i)].bounds.meets(window) && !look(u(entries_[u(i)].number))) return false;
        return true;
    }

    template <class Look>
    bool visit_groups(idx a, idx b, Look& look) const
    {
        const node &m = nodes_[u(a)], &n = nodes_[u(b)];
        if (!m.bounds.meets(n.bounds)) return true;
        if (m.group != none && n.group != none) return a == b || look(m.group, n.group);
        if (a == b)
            return visit_groups(m.left, m.left, look) && visit_groups(m.right, m.right, look) &&
                   visit_groups(m.left, m.right, look);
        if (larger(m, n)) return visit_groups(m.left, b, look) && visit_groups(m.right, b, look);
        return visit_groups(a, n.left, look) && visit_groups(a, n.right, look);
    }

    std::vector<entry> entries_;
    std::vector<node> nodes_;
    idx root_ = 0;
};

/// Calls meet(i, j), i < j, for the numbers of each pair of edges that meet, until it returns false or `tests` pairs
/// whose boxes meet were looked at. O(n log n) plus those pairs. Returns whether all were.
template <class Meet>
bool for_each_meeting(std::span<const std::array<idx, 2>> edges, std::span<const vec2> x, Meet&& meet,
                      std::size_t tests = std::numeric_limits<std::size_t>::max())
{
    constexpr std::size_t few = 24; // edges of which all pairs are looked at sooner than a tree is made
    bool all = true;
    const auto look = [&](std::size_t i, std::size_t j)
    {
        all = tests > 0;
        if (!all) return false;
        --tests;
        all = !edges_meet(edges[i], edges[j], x) || meet(i, j);
        return all;
    };
    if (edges.size() > few)
    {
        edge_tree(edges, x).for_each_pair(look);
        return all;
    }
    std::array<edge_box, few> boxes;
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
        boxes[i] = edge_box::of(edges[i], x);
        for (std::size_t j = 0; j < i; ++j)
            if (boxes[i].meets(boxes[j]) && !look(j, i)) return false;
    }
    return all;
}

std::vector<std::array<idx, 2>> edges_of(std::span<const std::vector<idx>> loops);

/// Count of crossings up to a limit of work.
struct crossing_count
{
    std::size_t pairs = 0;
    bool all = true; ///< false: there are at least so many
};

/// boundary_crossings() that ends at `most` crossings, or at a limit of work: overlapping charts have as many crossings
/// as pairs of edges.
inline crossing_count count_boundary_crossings(std::span<const std::vector<idx>> loops, std::span<const vec2> x,
                                               std::size_t most = 100'000)
{
    const auto edges = impl::edges_of(loops);
    crossing_count count;
    count.all = impl::for_each_meeting(
        edges, x, [&](std::size_t, std::size_t) { return ++count.pairs < most; }, 64 * edges.size() + 10 * most);
    return count;
}

} // namespace taut::impl
