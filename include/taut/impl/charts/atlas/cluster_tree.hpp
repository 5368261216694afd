// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/arc_graph.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/charts/atlas/chart_moments.hpp>
#include <taut/impl/charts/atlas/seams/seam_factors.hpp>
#include <taut/impl/core/core/budget.hpp>

namespace taut::impl
{

/// Binary tree of the pairwise unions of triangles to larger pieces of a surface. Every piece is a disk, or one with
/// holes of the surface in it, and can be flattened. Any antichain of nodes that covers the surface is a set of charts.
///
/// Nodes 0 .. leaves - 1 are the triangles, then the holes; those behind are pieces in the order in which they were
/// made. A piece of one child is the child with a slit stitched.
struct cluster_tree
{
    static constexpr idx none = -1;
    static constexpr idx never = std::numeric_limits<idx>::max();

    idx triangles = 0;                        ///< triangles of the surface
    idx leaves = 0;                           ///< and its holes
    std::vector<std::array<idx, 2>> children; ///< one per piece; the second may be none
    std::vector<idx> parents;                 ///< one per node; none for roots
    std::vector<idx> sewn;                    ///< one per side: the node that stitched its edge, or never
    std::vector<double> area;                 ///< one per node
    std::vector<double> strain;               ///< one per node: estimated distortion above the minimum, times area

    idx nodes() const { return leaves + static_cast<idx>(children.size()); }

    /// Number of triangles below each node.
    std::vector<idx> triangles_below() const
    {
        std::vector<idx> below(static_cast<std::size_t>(nodes()), 0);
        for (idx n = 0; n < nodes(); ++n)
        {
            const auto i = static_cast<std::size_t>(n);
            if (n < triangles) below[i] = 1;
            if (parents[i] != none) below[static_cast<std::size_t>(parents[i])] += below[i];
        }
        return below;
    }

    /// Charts of an antichain: for each triangle the node among `chosen` (one flag per node) that it is in.
    std::vector<idx> labels(std::span<const char> chosen) const
    {
        std::vector<idx> label(static_cast<std::size_t>(nodes()), none);
        for (idx n = nodes(); n-- > 0;)
        {
            const auto i = static_cast<std::size_t>(n);
            if (chosen[i])
                label[i] = n;
            else if (parents[i] != none)
                label[i] = label[static_cast<std::size_t>(parents[i])];
        }
        label.resize(static_cast<std::size_t>(triangles));
        return label;
    }

    /// Seams of charts as given by labels(), one flag per side: edges between charts, and slits in a chart.
    std::vector<char> seams(const facet_table& f, std::span<const idx> label) const
    {
        std::vector<char> seam = seams_between(f, label);
        parallel_for(seam.size(),
                     [&](std::size_t begin, std::size_t end)
                     {
                         for (std::size_t s = begin; s < end; ++s)
                             if (f.twin[s] >= 0 && sewn[s] > label[s / 3]) seam[s] = 1;
                     });
        return seam;
    }
};

/// Unites neighbouring pieces in the order of merge cost, added distortion per saved seam length.
class clustering
{
public:
    /// keep: one flag per side, edges that remain seams, or empty; together: edges removed before all others, or empty
    /// apart: pairs of triangles that are kept in different pieces; weights: as segment_params::weights
    clustering(const mesh<triangle>& m, const facet_table& f, std::span<const char> keep,
               std::span<const char> together, std::span<const std::array<idx, 2>> apart,
               std::span<const double> weights)
        : mesh_(m),
          facets_(f),
          together_(together),
          graph_(m, f),
          sides_(static_cast<idx>(f.twin.size())),
          pieces_(u(graph_.polygons())),
          arcs_(u(graph_.half_arcs())),
          stamp_(arcs_.size(), 0),
          after_(f.twin.size(), -1),
          rivals_(apart.empty() ? 0 : pieces_.size())
    {
        for (const auto& [a, b] : apart)
        {
            rivals_[u(a)].push_back(b);
            rivals_[u(b)].push_back(a);
        }
        tree_.triangles = m.cell_count();
        tree_.leaves = graph_.polygons();
        tree_.sewn.assign(f.twin.size(), cluster_tree::never);
        tree_.parents.assign(pieces_.size(), cluster_tree::none);
        for (idx p = 0; p < tree_.leaves; ++p)
        {
            piece& one = pieces_[u(p)];
            one.node = p;
            if (p < tree_.triangles)
            {
                const auto x = m.rest(p);
                one.moments = chart_moments::of_triangle(glm::cross(x[1] - x[0], x[2] - x[0]));
            }
            tree_.area.push_back(one.moments.area);
            tree_.strain.push_back(0);
        }
        measure_nodes();
        const auto weight = seam_weights(m, f, weights);
        for (idx h = 0; h < sides_; ++h)
            if (graph_.arc(h) == h)
            {
                const idx t = graph_.twin(h);
                const bool border =
                    t >= sides_ ? open_[u(graph_.polygon(t) - tree_.triangles)] != 0 : !keep.empty() && keep[u(h)] != 0;
                const auto [a, b] = side_vertices(mesh_, h);
                const double length = glm::distance(mesh_.points()[u(a)], mesh_.points()[u(b)]);
                arcs_[u(h)] = {.first = h, .last = h, .length = length, .worth = weight[u(h)], .border = border};
                for (const idx s : {h, t}) pieces_[u(graph_.polygon(s))].moments.perimeter += length;
            }
    }

    /// limits: asked periodically; once it refuses, the current pieces are returned
    cluster_tree run(budget* limits)
    {
        constexpr int often = 4096; // some milliseconds
        int until_asked = 0;
        for (idx h = 0; h < sides_; ++h)
            if (graph_.arc(h) == h)
            {
                if (!together_.empty() && together_[u(h)] != 0)
                    push(h, -infinite);
                else
                    offer(h);
            }
        while (!queue_.empty())
        {
            if (limits != nullptr && until_asked-- == 0)
            {
                until_asked = often;
                if (!limits->proceed()) break;
            }
            const offered e = queue_.top();
            queue_.pop();
            if (!graph_.alive(e.arc) || stamp_[u(e.arc)] != e.stamp) continue;
            // What is beside an arc has grown since it was offered. Small changes do not count, so that an arc beside a
            // large piece is not offered anew for every triangle that this takes in.
            const double price = price_of(e.arc);
            if (price == infinite) continue;
            if (e.price > -infinite && price > e.price + 0.1 * std::abs(e.price))
                push(e.arc, price);
            else
                remove(e.arc);
        }
        return std::move(tree_);
    }

private:
    static constexpr double infinite = std::numeric_limits<double>::infinity();

    struct piece
    {
        chart_moments moments;
        double strain = 0, noise = 0;
        idx triangles = 1, node = 0;
    };

    struct arc
    {
        idx first = -1, last = -1; // of its sides, in a list
        double length = 0;
        double worth = 0;    // of the seam that goes with it
        bool border = false; // never removed
    };

    struct offered
    {
        double price;
        idx arc;
        int stamp;
        bool operator<(const offered& o) const { return price != o.price ? price > o.price : arc > o.arc; }
    };

    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    /// Detects corners and open holes by the Gaussian curvature of nodes. A hole is filled with a polygon of equal
    /// angles; a hole that is then far from flat is open: no chart encloses it. A corner is curved together with its
    /// neighbours, too, unlike noise.
    void measure_nodes()
    {
        constexpr double pi = std::numbers::pi;
        std::vector<idx> rim(u(tree_.leaves - tree_.triangles), 0);
        const auto hole = [&](idx h) { return u(graph_.polygon(h) - tree_.triangles); };
        for (idx h = sides_; h < graph_.half_arcs(); ++h) ++rim[hole(h)];
        std::vector<char> on_rim(u(graph_.nodes()), 0);
        std::vector<double> curvature(on_rim.size(), 2 * pi);
        for (idx h = 0; h < graph_.half_arcs(); ++h)
        {
            const auto node = u(graph_.start(h));
            if (h >= sides_)
            {
                on_rim[node] = 1;
                curvature[node] -= pi * (1 - 2.0 / rim[hole(h)]);
                continue;
            }
            const auto x = mesh_.rest(h / 3);
            const auto k = u(h % 3);
            const vec3 a = x[(k + 2) % 3] - x[(k + 1) % 3], b = x[k] - x[(k + 1) % 3];
            curvature[node] -= std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
        }
        std::vector<double> total(rim.size(), 0);
        for (idx h = sides_; h < graph_.half_arcs(); ++h) total[hole(h)] += curvature[u(graph_.start(h))];
        for (const double t : total) open_.push_back(std::abs(t) > 0.5);
        std::vector<double> around = curvature;
        for (idx h = 0; h < sides_; ++h) around[u(graph_.start(h))] += curvature[u(graph_.start(graph_.twin(h)))];
        for (std::size_t n = 0; n < curvature.size(); ++n)
        {
            const double k = curvature[n];
            const bool sharp = !on_rim[n] && std::min(k * around[n], k * k) > 0.64;
            corner_.push_back(sharp ? k * k / (4 * pi * pi) : 0); // the energy of a cone, nearly
        }
    }

    /// Piece that results from the removal of an arc.
    chart_moments without(idx h)
    {
        chart_moments result = pieces_[u(graph_.polygon(h))].moments;
        if (graph_.parts(h)) result += pieces_[u(graph_.polygon(graph_.twin(h)))].moments;
        result.perimeter -= 2 * arcs_[u(h)].length;
        return result;
    }

    /// Merge cost: added distortion per saved seam length.
    double price_of(idx h)
    {
        const idx t = graph_.twin(h);
        const piece& p = pieces_[u(graph_.polygon(h))];
        double cost = -p.strain;
        const bool parts = graph_.parts(h) && !are_rivals(graph_.polygon(h), graph_.polygon(t));
        const bool slit = !parts && (graph_.dangles(h) || graph_.dangles(t));
        if (arcs_[u(h)].border || leaves_one_edge(h) || (!parts && !slit)) return infinite;
        if (parts) cost -= pieces_[u(graph_.polygon(t))].strain;
        if (slit) cost += p.moments.area * corner_[u(graph_.start(graph_.dangles(h) ? t : h))];
        return (cost + without(h).strain()) / arcs_[u(h)].worth;
    }

    /// Returns whether the boundary of the piece would be a slit of one edge.
    bool leaves_one_edge(idx h) const
    {
        const idx last = graph_.last_without(h);
        return last >= 0 && arcs_[u(last)].first == arcs_[u(last)].last;
    }

    /// Returns whether two pieces, by their polygons, have triangles that must be separate.
    bool are_rivals(idx p, idx q)
    {
        if (rivals_.empty()) return false;
        if (rivals_[u(p)].size() > rivals_[u(q)].size()) std::swap(p, q);
        const auto& some = rivals_[u(p)];
        return std::any_of(some.begin(), some.end(), [&](idx c) { return graph_.polygon(3 * c) == q; });
    }

    void push(idx h, double price) { queue_.push({price, h, ++stamp_[u(h)]}); }

    void offer(idx h)
    {
        if (const double price = price_of(h); price < infinite) push(h, price);
    }

    void remove(idx h)
    {
        constexpr idx grain = 32;           // triangles over which normals vary by noise alone
        constexpr double most_noise = 0.02; // normals 20 degrees off
        const piece& p = pieces_[u(graph_.polygon(h))];
        piece result{.moments = {}, .noise = p.noise, .triangles = p.triangles, .node = tree_.nodes()};
        std::array<idx, 2> children{p.node, cluster_tree::none};
        result.moments = without(h);
        if (graph_.parts(h))
        {
            const piece& q = pieces_[u(graph_.polygon(graph_.twin(h)))];
            children[1] = q.node;
            result.noise += q.noise;
            result.triangles += q.triangles;
        }
        result.strain = result.moments.strain();
        if (result.triangles <= grain) result.noise = std::min(result.strain, most_noise * result.moments.area);

        for (idx s = arcs_[u(h)].first; s >= 0; s = after_[u(s)])
        {
            tree_.sewn[u(s)] = result.node;
            if (facets_.twin[u(s)] >= 0) tree_.sewn[u(facets_.twin[u(s)])] = result.node;
        }
        for (const idx child : children)
            if (child != cluster_tree::none) tree_.parents[u(child)] = result.node;
        tree_.children.push_back(children);
        tree_.parents.push_back(cluster_tree::none);
        tree_.area.push_back(result.moments.area);
        tree_.strain.push_back(std::max(0.0, result.strain - result.noise));

        std::vector<idx> rivals;
        if (!rivals_.empty() && graph_.parts(h))
        {
            auto &a = rivals_[u(graph_.polygon(h))], &b = rivals_[u(graph_.polygon(graph_.twin(h)))];
            if (a.size() < b.size()) std::swap(a, b);
            a.insert(a.end(), b.begin(), b.end());
            rivals = std::move(a);
        }
        const bool parted = children[1] != cluster_tree::none;
        const auto [one, other] = graph_.remove(h);
        const auto polygon = u(graph_.polygon(one >= 0 ? one : other));
        pieces_[polygon] = result;
        if (!rivals_.empty() && parted) rivals_[polygon] = std::move(rivals);
        const idx before = one >= 0 ? graph_.prev(one) : -1;
        if (one >= 0) settle(one);
        // Where both ends were those of one arc, that one has gone with the first.
        if (other >= 0) settle(graph_.alive(other) ? other : graph_.twin(before));
    }

    /// Settles the start of h: joins the two arcs that meet there, or queues the one that ends there.
    void settle(idx h)
    {
        const auto node = u(graph_.start(h));
        if (graph_.degree(graph_.start(h)) == 1) return offer(graph_.arc(h));
        const idx p = graph_.prev(h);
        const arc& b = arcs_[u(graph_.arc(h))];
        arc& a = arcs_[u(graph_.arc(p))];
        if (!graph_.passes(h) || corner_[node] > 0 || a.border != b.border) return;
        after_[u(a.last)] = b.first;
        a.last = b.last;
        a.length += b.length;
        a.worth += b.worth;
        graph_.join_at_start(h);
        offer(graph_.arc(p));
    }

    const mesh<triangle>& mesh_;
    const facet_table& facets_;
    std::span<const char> together_;
    arc_graph graph_;
    idx sides_;
    std::vector<piece> pieces_;            // one per polygon
    std::vector<arc> arcs_;                // one per arc, by its number
    std::vector<int> stamp_;               // of the offer that counts
    std::vector<idx> after_;               // next side of an arc
    std::vector<double> corner_;           // one per node that remains an end of arcs: distortion if inside; 0: none
    std::vector<char> open_;               // holes
    std::vector<std::vector<idx>> rivals_; // one per polygon: triangles that its piece is to be without; or empty
    std::priority_queue<offered> queue_;
    cluster_tree tree_;
};

/// Clusters a surface. Deterministic; time O(n log n).
/// m:    an oriented manifold; with any components, handles and holes; f: its facets
/// keep: one flag per side, edges that are to remain seams, the same on both sides; or empty
/// together: edges whose triangles are united before all others, in the same way
/// apart: pairs of triangles that are kept in different pieces
/// limits: asked periodically, or null; once it refuses, the current tree is returned
inline cluster_tree make_cluster_tree(const mesh<triangle>& m, const facet_table& f, std::span<const char> keep = {},
                                      std::span<const char> together = {},
                                      std::span<const std::array<idx, 2>> apart = {}, budget* limits = nullptr,
                                      std::span<const double> weights = {})
{
    return impl::clustering(m, f, keep, together, apart, weights).run(limits);
}

} // namespace taut::impl
