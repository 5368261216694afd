// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/core/parallel.hpp>
#include <taut/core/types.hpp>
#include <taut/exact/predicates.hpp>

namespace taut
{

namespace detail
{

/// True if r, known to lie on the line through p and q, is on the closed segment.
inline bool between(const vec2& p, const vec2& q, const vec2& r)
{
    return std::min(p.x, q.x) <= r.x && r.x <= std::max(p.x, q.x) && std::min(p.y, q.y) <= r.y &&
           r.y <= std::max(p.y, q.y);
}

/// True if the closed segments ab and cd have a common point; exact.
inline bool segments_meet(const vec2& a, const vec2& b, const vec2& c, const vec2& d)
{
    const int abc = orient2d(a, b, c);
    const int abd = orient2d(a, b, d);
    const int cda = orient2d(c, d, a);
    const int cdb = orient2d(c, d, b);
    if (abc * abd < 0 && cda * cdb < 0) return true;
    return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) || (cda == 0 && between(c, d, a)) ||
           (cdb == 0 && between(c, d, b));
}

/// True if segments ab and bc share more than b: c folds back over ab.
inline bool folds_back(const vec2& a, const vec2& b, const vec2& c)
{
    return orient2d(a, b, c) == 0 && (between(a, b, c) || between(b, c, a));
}

/// True if the images of two edges have a common point beyond a common end vertex.
inline bool edges_meet(const std::array<idx, 2>& e, const std::array<idx, 2>& f, std::span<const vec2> x)
{
    const auto at = [&x](idx v) { return x[static_cast<std::size_t>(v)]; };
    const auto [a, b] = e;
    const auto [c, d] = f;
    if ((a == c && b == d) || (a == d && b == c)) return true;
    if (b == c) return folds_back(at(a), at(b), at(d));
    if (a == d) return folds_back(at(b), at(a), at(c));
    if (a == c) return folds_back(at(b), at(a), at(d));
    if (b == d) return folds_back(at(a), at(b), at(c));
    return segments_meet(at(a), at(b), at(c), at(d));
}

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

/// A binary tree of boxes about edges: halves along the longer side of what a node holds.
class edge_tree
{
public:
    /// Edges with finite ends. group: one an edge, or empty; pairs of one group are left out
    edge_tree(std::span<const std::array<idx, 2>> edges, std::span<const vec2> x, std::span<const idx> group = {})
        : entries_(edges.size()), nodes_(edges.empty() ? 0 : std::max<std::size_t>(1, edges.size() - 1))
    {
        for (std::size_t e = 0; e < edges.size(); ++e)
            entries_[e] = {edge_box::of(edges[e], x), e, group.empty() ? -1 : group[e]};
        if (edges.empty()) return;
        constexpr std::size_t large = 8192; // edges that are worth another thread
        std::vector<std::vector<part>> levels{{{0, 0, edges.size()}}};
        while (levels.back().front().last - levels.back().front().first > large)
        {
            const auto& above = levels.back();
            std::vector<part> below(2 * above.size());
            parallel_for(
                above.size(),
                [&](std::size_t begin, std::size_t end)
                {
                    for (std::size_t k = begin; k < end; ++k)
                        std::tie(below[2 * k], below[2 * k + 1]) = halve(above[k]);
                },
                0, 1);
            levels.push_back(std::move(below));
        }
        parallel_for(
            levels.back().size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t k = begin; k < end; ++k) build(levels.back()[k]);
            },
            0, 1);
        for (std::size_t k = levels.size() - 1; k-- > 0;)
            for (const part& p : levels[k]) join_groups(nodes_[p.node]);
    }

    /// Calls look(i, j), i < j, for each pair of edges whose boxes meet, until it returns false.
    template <class Look>
    void for_each_pair(Look&& look) const
    {
        const auto meet = [](const edge_box& a, const edge_box& b) { return a.meets(b); };
        if (!nodes_.empty()) visit(0, 0, look, meet);
    }

    /// The same of pairs whose boxes are nearer than `reach`, which `look` may make smaller.
    template <class Look>
    void for_each_pair_within(const double& reach, Look&& look) const
    {
        const auto near = [&reach](const edge_box& a, const edge_box& b) { return a.distance(b) < reach; };
        if (!nodes_.empty()) visit(0, 0, look, near);
    }

    /// Calls look(i) for each edge whose box meets the one from low to high, until it returns false.
    template <class Look>
    void for_each_in(const vec2& low, const vec2& high, Look&& look) const
    {
        if (!nodes_.empty()) visit_in(0, {low, high}, look);
    }

private:
    struct entry
    {
        edge_box bounds;
        std::size_t edge;
        idx group;

        double centre(int side) const { return bounds.low[side] / 2 + bounds.high[side] / 2; }
    };

    struct node
    {
        edge_box bounds;
        std::size_t first, last;         // of entries_
        std::size_t left = 0, right = 0; // 0: a leaf
        idx group = -1;                  // that all are of; -1: of several
    };

    /// Entries of a node. It and those below it are as many as there are entries, at most.
    struct part
    {
        std::size_t node, first, last;
    };

    static constexpr std::size_t leaf = 4;

    /// Makes the node of a part without what is below it.
    node& enclose(const part& p)
    {
        node& made = nodes_[p.node];
        made = {entries_[p.first].bounds, p.first, p.last};
        for (std::size_t k = p.first; k < p.last; ++k)
        {
            made.bounds.low = glm::min(made.bounds.low, entries_[k].bounds.low);
            made.bounds.high = glm::max(made.bounds.high, entries_[k].bounds.high);
        }
        return made;
    }

    std::pair<part, part> halve(const part& p)
    {
        node& whole = enclose(p);
        const vec2 extent = whole.bounds.high / 2.0 - whole.bounds.low / 2.0;
        const int side = extent.x >= extent.y ? 0 : 1;
        const std::size_t half = (p.last - p.first) / 2, middle = p.first + half;
        const auto at = [this](std::size_t k) { return entries_.begin() + static_cast<std::ptrdiff_t>(k); };
        std::nth_element(at(p.first), at(middle), at(p.last),
                         [side](const entry& a, const entry& b)
                         {
                             const double x = a.centre(side), y = b.centre(side);
                             return x != y ? x < y : a.edge < b.edge;
                         });
        whole.left = p.node + 1;
        whole.right = p.node + half;
        return {{whole.left, p.first, middle}, {whole.right, middle, p.last}};
    }

    void build(const part& p)
    {
        if (p.last - p.first > leaf)
        {
            const auto [left, right] = halve(p);
            build(left);
            build(right);
            join_groups(nodes_[p.node]);
            return;
        }
        node& made = enclose(p);
        made.group = entries_[p.first].group;
        for (std::size_t k = p.first; k < p.last; ++k)
            if (entries_[k].group != made.group) made.group = -1;
    }

    void join_groups(node& n) const
    {
        if (nodes_[n.left].group == nodes_[n.right].group) n.group = nodes_[n.left].group;
    }

    /// Looks at the pairs of an edge of node a and one of node b; a == b: at those within it.
    template <class Look, class Near>
    bool visit(std::size_t a, std::size_t b, Look& look, const Near& near) const
    {
        const node &m = nodes_[a], &n = nodes_[b];
        if ((m.group >= 0 && m.group == n.group) || !near(m.bounds, n.bounds)) return true;
        if (m.left == 0 && n.left == 0)
        {
            for (std::size_t i = m.first; i < m.last; ++i)
                for (std::size_t j = a == b ? i + 1 : n.first; j < n.last; ++j)
                {
                    const entry &e = entries_[i], &f = entries_[j];
                    if ((e.group < 0 || e.group != f.group) && near(e.bounds, f.bounds) &&
                        !look(std::min(e.edge, f.edge), std::max(e.edge, f.edge)))
                        return false;
                }
            return true;
        }
        if (a == b)
            return visit(m.left, m.left, look, near) && visit(m.right, m.right, look, near) &&
                   visit(m.left, m.right, look, near);
        // The larger one is halved.
        if (n.left == 0 || (m.left != 0 && m.last - m.first >= n.last - n.first))
            return visit(m.left, b, look, near) && visit(m.right, b, look, near);
        return visit(a, n.left, look, near) && visit(a, n.right, look, near);
    }

    template <class Look>
    bool visit_in(std::size_t a, const edge_box& window, Look& look) const
    {
        const node& m = nodes_[a];
        if (!m.bounds.meets(window)) return true;
        if (m.left != 0) return visit_in(m.left, window, look) && visit_in(m.right, window, look);
        for (std::size_t i = m.first; i < m.last; ++i)
            if (entries_[i].bounds.meets(window) && !look(entries_[i].edge)) return false;
        return true;
    }

    std::vector<entry> entries_;
    std::vector<node> nodes_;
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

inline std::vector<std::array<idx, 2>> edges_of(std::span<const std::vector<idx>> loops)
{
    std::vector<std::array<idx, 2>> edges;
    for (const auto& loop : loops)
        for (std::size_t k = 0; k < loop.size(); ++k) edges.push_back({loop[k], loop[(k + 1) % loop.size()]});
    return edges;
}

} // namespace detail

/// Number of pairs of boundary edges whose images have a common point beyond a common end vertex: crossings, touchings
/// and overlaps. Exact. 0 together with a clean certificate means that a disk's map is injective.
///
/// loops: boundary loops as vertex indices, each of at least two; x: #V image points, finite.
inline std::size_t boundary_crossings(std::span<const std::vector<idx>> loops, std::span<const vec2> x)
{
    std::size_t count = 0;
    detail::for_each_meeting(detail::edges_of(loops), x,
                             [&count](std::size_t, std::size_t)
                             {
                                 ++count;
                                 return true;
                             });
    return count;
}

/// Crossings that were counted as far as it took little time.
struct crossing_count
{
    std::size_t pairs = 0;
    bool all = true; ///< false: there are at least so many
};

/// boundary_crossings() that ends at `most` crossings, or where there is too much to look at: charts that lie on each
/// other have as many crossings as pairs of edges.
inline crossing_count count_boundary_crossings(std::span<const std::vector<idx>> loops, std::span<const vec2> x,
                                               std::size_t most = 100'000)
{
    const auto edges = detail::edges_of(loops);
    crossing_count count;
    count.all = detail::for_each_meeting(
        edges, x, [&](std::size_t, std::size_t) { return ++count.pairs < most; }, 64 * edges.size() + 10 * most);
    return count;
}

} // namespace taut
