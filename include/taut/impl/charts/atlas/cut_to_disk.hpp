// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/seams/seam_arcs.hpp>
#include <taut/impl/charts/atlas/seams/seam_factors.hpp>
#include <taut/impl/core/core/disjoint_sets.hpp>

namespace taut::impl
{

/// Shortest paths along the edges of a surface from a set of vertices.
class edge_ways
{
public:
    std::vector<double> distance; ///< one per vertex
    std::vector<idx> came;        ///< the last side of the way, one per vertex; -1 at starts

    edge_ways(const mesh<triangle>& m, const facet_table& f, const csr& sides, const std::vector<double>& weight)
        : distance(m.points().size(), std::numeric_limits<double>::infinity()),
          came(m.points().size(), -1),
          mesh_(m),
          facets_(f),
          sides_(sides),
          weight_(weight)
    {
    }

    /// Adds a source, at distance 0.
    void add(idx v)
    {
        distance[static_cast<std::size_t>(v)] = 0;
        came[static_cast<std::size_t>(v)] = -1;
        queue_.emplace(0.0, v);
    }

    /// Runs Dijkstra's algorithm from the new sources.
    void run()
    {
        const auto u = [](idx i) { return static_cast<std::size_t>(i); };
        while (!queue_.empty())
        {
            const auto [here, v] = queue_.top();
            queue_.pop();
            if (here != distance[u(v)]) continue;
            for (const idx s : sides_.row(v))
            {
                if (facets_.twin[u(s)] < 0) continue;
                const idx w = first_vertex(mesh_, facets_.twin[u(s)]);
                if (const double there = here + weight_[u(s)]; there < distance[u(w)])
                {
                    distance[u(w)] = there;
                    came[u(w)] = s;
                    queue_.emplace(there, w);
                }
            }
        }
    }

private:
    using entry = std::pair<double, idx>;

    const mesh<triangle>& mesh_;
    const facet_table& facets_;
    const csr& sides_;
    const std::vector<double>& weight_;
    std::priority_queue<entry, std::vector<entry>, std::greater<>> queue_;
};

/// Finds the seams of cut_to_disk().
class disk_cutting
{
public:
    /// together: one flag per side, edges that are never cut, as the diagonals of polygons; or empty
    disk_cutting(const mesh<triangle>& m, const facet_table& f, std::span<const char> together = {})
        : mesh_(m),
          facets_(f),
          sides_(starting_sides(m)),
          weight_(seam_weights(m, f)),
          seam_(f.twin.size(), 0),
          component_(m.points().size()),
          on_rim_(component_.size(), 0),
          kind_(component_.size(), kind::closed)
    {
        for (std::size_t s = 0; s < together.size(); ++s)
            if (together[s] != 0) weight_[s] = never;
        disjoint_sets parts(m.vertex_count());
        for (const auto& t : m.cells())
            for (const idx v : t) parts.join(t[0], v);
        for (std::size_t v = 0; v < component_.size(); ++v) component_[v] = parts.find(static_cast<idx>(v));

        // Euler: V - E + F = 2 for a closed component without handles. An inner edge has two sides.
        std::vector<idx> twice(component_.size(), 0);
        for (std::size_t v = 0; v < component_.size(); ++v) twice[u(component_[v])] += 2;
        for (const auto& t : m.cells()) twice[u(component_[u(t[0])])] += 2 - 3;
        for (std::size_t v = 0; v < component_.size(); ++v)
            if (twice[v] == 4) kind_[v] = kind::sphere;
        for (idx s = 0; s < static_cast<idx>(f.twin.size()); ++s)
            if (f.twin[u(s)] < 0)
            {
                on_rim_[u(first_vertex(m, s))] = 1;
                kind_[u(component_[u(first_vertex(m, s))])] = kind::open;
            }
    }

    std::vector<char> run()
    {
        const std::vector<idx> roots = far_points();
        cut_handles(roots);
        prune();
        cut_spheres(roots);
        return std::move(seam_);
    }

    /// Of handles and boundaries alone: a closed component without handles stays closed.
    std::vector<char> loops()
    {
        cut_handles(far_points());
        prune();
        return std::move(seam_);
    }

private:
    enum class kind : char
    {
        open,
        closed, // with handles
        sphere
    };

    static constexpr double never = std::numeric_limits<double>::infinity(); // the weight of edges that are not cut

    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    edge_ways ways() const { return {mesh_, facets_, sides_, weight_}; }
    idx start(idx s) const { return first_vertex(mesh_, s); }
    idx end(idx s) const { return start(facets_.twin[u(s)]); }
    void mark(idx s, char value) { seam_[u(s)] = seam_[u(facets_.twin[u(s)])] = value; }

    /// Farthest vertex of each component, stored at its first vertex.
    std::vector<idx> farthest(const std::vector<double>& distance) const
    {
        std::vector<idx> best(component_.size(), -1);
        for (idx v = 0; v < mesh_.vertex_count(); ++v)
            if (!sides_.row(v).empty())
                if (idx& b = best[u(component_[u(v)])]; b < 0 || distance[u(v)] > distance[u(b)]) b = v;
        return best;
    }

    /// Extremal point of each component.
    std::vector<idx> far_points() const
    {
        edge_ways from_first = ways();
        for (idx v = 0; v < mesh_.vertex_count(); ++v)
            if (component_[u(v)] == v) from_first.add(v);
        from_first.run();
        return farthest(from_first.distance);
    }

    /// Unites triangles across edges, in the order of the longest loop of shortest paths to the boundary, or to the
    /// root of a closed component; these paths are never crossed. The remaining edges are a shortest set of loops and
    /// of paths between boundaries (Erickson, Whittlesey 2005), and branches.
    void cut_handles(const std::vector<idx>& roots)
    {
        edge_ways back = ways();
        for (idx v = 0; v < mesh_.vertex_count(); ++v)
        {
            const idx c = component_[u(v)];
            if (on_rim_[u(v)] || (kind_[u(c)] != kind::open && roots[u(c)] == v)) back.add(v);
        }
        back.run();
        std::vector<std::pair<double, idx>> edges; // by the length of their loops
        for (idx s = 0; s < static_cast<idx>(seam_.size()); ++s)
        {
            if (facets_.twin[u(s)] <= s) continue;
            mark(s, 1);
            if (weight_[u(s)] < never && back.came[u(end(s))] != s && back.came[u(start(s))] != facets_.twin[u(s)])
                edges.emplace_back(-(weight_[u(s)] + back.distance[u(start(s))] + back.distance[u(end(s))]), s);
        }
        std::sort(edges.begin(), edges.end());
        disjoint_sets united(mesh_.cell_count());
        for (idx s = 0; s < static_cast<idx>(seam_.size()); ++s)
            if (seam_[u(s)] != 0 && weight_[u(s)] == never && united.join(s / 3, facets_.twin[u(s)] / 3)) mark(s, 0);
        for (const auto& edge : edges)
            if (united.join(edge.second / 3, facets_.twin[u(edge.second)] / 3)) mark(edge.second, 0);
    }

    /// Removes seams with free ends.
    void prune()
    {
        std::vector<idx> degree(component_.size(), 0);
        for (idx s = 0; s < static_cast<idx>(seam_.size()); ++s)
            if (facets_.twin[u(s)] < 0 || seam_[u(s)]) degree[u(start(s))] += facets_.twin[u(s)] < 0 ? 2 : 1;
        std::vector<idx> tips;
        for (idx v = 0; v < mesh_.vertex_count(); ++v)
            if (degree[u(v)] == 1) tips.push_back(v);
        while (!tips.empty())
        {
            const idx v = tips.back();
            tips.pop_back();
            for (const idx s : sides_.row(v))
                if (facets_.twin[u(s)] >= 0 && seam_[u(s)])
                {
                    mark(s, 0);
                    --degree[u(v)];
                    if (--degree[u(end(s))] == 1) tips.push_back(end(s));
                }
        }
    }

    /// Cuts along the path to the farthest point, then to points that are still far from the seams, so that limbs open.
    void cut_spheres(const std::vector<idx>& roots)
    {
        constexpr int limbs = 6;       // at most
        constexpr double short_ = 0.4; // of the first way: not worth a seam
        edge_ways to_seam = ways();
        for (idx c = 0; c < mesh_.vertex_count(); ++c)
            if (kind_[u(c)] == kind::sphere && roots[u(c)] >= 0) to_seam.add(roots[u(c)]);
        std::vector<double> first(component_.size(), 0);
        std::vector<idx> edges(component_.size(), 0);
        for (int limb = 0; limb < limbs; ++limb)
        {
            to_seam.run();
            const auto tips = farthest(to_seam.distance);
            for (idx c = 0; c < mesh_.vertex_count(); ++c)
            {
                if (kind_[u(c)] != kind::sphere || tips[u(c)] < 0) continue;
                const double length = to_seam.distance[u(tips[u(c)])];
                if (limb == 0) first[u(c)] = length;
                if (edges[u(c)] > 1 && length < short_ * first[u(c)]) continue; // a seam of one edge opens nothing
                std::vector<idx> way;
                for (idx v = tips[u(c)]; to_seam.came[u(v)] >= 0; v = start(way.back()))
                    way.push_back(to_seam.came[u(v)]);
                for (const idx s : way)
                {
                    mark(s, 1);
                    ++edges[u(c)];
                    to_seam.add(end(s));
                }
            }
        }
    }

    const mesh<triangle>& mesh_;
    const facet_table& facets_;
    csr sides_;
    std::vector<double> weight_;
    std::vector<char> seam_;
    std::vector<idx> component_; // one per vertex: the first vertex of it
    std::vector<char> on_rim_;   // one per vertex
    std::vector<kind> kind_;     // of components, at their first vertex
};

/// cut_to_disk() of a surface whose facets are f. together: as of disk_cutting
inline std::vector<char> cut_to_disk(const mesh<triangle>& m, const facet_table& f, std::span<const char> together = {})
{
    return disk_cutting(m, f, together).run();
}

} // namespace taut::impl
