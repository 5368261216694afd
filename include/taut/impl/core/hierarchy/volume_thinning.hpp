// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/elements.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/mesh.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Shape of a tetrahedron, 1 if regular: the cube of the mean ratio, with the sign of the volume.
inline double tetrahedron_quality(const vec3& a, const vec3& b, const vec3& c, const vec3& d)
{
    const vec3 edges[] = {b - a, c - a, d - a, c - b, d - b, d - c};
    const double det = glm::dot(glm::cross(edges[0], edges[1]), edges[2]);
    double squares = 0;
    for (const vec3& e : edges) squares += glm::dot(e, e);
    return 432 * det * std::abs(det) / (squares * squares * squares);
}

/// Conditions of a collapse. Strict at first, relaxed when too few vertices qualify.
struct volume_collapse_rules
{
    double quality; ///< least tetrahedron_quality of a new cell, unless the star has a worse one already
    double facing;  ///< least cosine between the normals of a face of the boundary before and after
};

/// Volume under decimation by half-edge collapses, at the boundary along the boundary. All cells stay positive and the
/// boundary stays a manifold (the link condition: Dey et al. 1999, "Topology preserving edge contraction").
class volume_thinning
{
public:
    using cell = mesh<tetrahedron>::cell;

    /// m: without inverted cells. kept: one flag per vertex, or none; flagged ones are kept unless all their neighbours
    /// are flagged, too.
    volume_thinning(const mesh<tetrahedron>& m, std::span<const char> kept)
        : points_(m.points()),
          cells_(m.cells()),
          kept_(kept.begin(), kept.end()),
          open_(points_.size(), 0),
          into_(points_.size()),
          stars_(points_.size()),
          mark_(points_.size(), 0),
          busy_(points_.size(), 0)
    {
        const double unit = unit_scale(m); // so that no product leaves the range of numbers; a power of two
        for (vec3& p : points_) p *= unit;
        for (const auto& face : boundary_facets(m))
            for (const idx v : face) open_[at(v)] = 1;
        const csr around = vertex_cells(m);
        for (std::size_t v = 0; v < into_.size(); ++v)
        {
            const auto row = around.row(static_cast<idx>(v));
            stars_[v].assign(row.begin(), row.end());
            into_[v] = row.empty() ? -1 : static_cast<idx>(v);
        }
    }

    /// Removes independent vertices; returns the number of those without a flag.
    std::size_t round(const volume_collapse_rules& rules)
    {
        std::size_t removed = 0;
        std::fill(busy_.begin(), busy_.end(), 0);
        for (std::size_t v = 0; v < into_.size(); ++v)
        {
            if (into_[v] != static_cast<idx>(v) || busy_[v]) continue;
            look_around(static_cast<idx>(v));
            if (is_kept(static_cast<idx>(v)) && !all_kept(ring_)) continue;
            const idx u = target(static_cast<idx>(v), rules);
            if (u < 0) continue;
            for (const idx w : ring_) busy_[at(w)] = 1;
            collapse(static_cast<idx>(v), u);
            removed += !is_kept(static_cast<idx>(v));
        }
        return removed;
    }

    /// Vertex that each vertex is collapsed into: itself where it remains, -1 without cells.
    std::vector<idx> into() const
    {
        auto last = into_;
        for (idx& v : last)
            while (v >= 0 && into_[at(v)] != v) v = into_[at(v)];
        return last;
    }

    /// Remaining vertices, in the numbering of the mesh.
    std::vector<cell> cells() const
    {
        std::vector<cell> left;
        for (const cell& t : cells_)
            if (t[0] >= 0) left.push_back(t);
        return left;
    }

private:
    using link_face = std::array<idx, 3>;
    using edge = std::array<idx, 2>;

    static constexpr std::size_t largest_star = 100; ///< cells; a larger one would cost more than it is worth

    static std::size_t at(idx v) { return static_cast<std::size_t>(v); }
    const vec3& point(idx v) const { return points_[at(v)]; }
    static bool has(const auto& corners, idx v)
    {
        return std::find(corners.begin(), corners.end(), v) != corners.end();
    }

    /// Face opposite v of a cell, oriented such that v followed by it has the orientation of the cell.
    static link_face opposite(const cell& t, idx v)
    {
        if (t[0] == v) return {t[1], t[2], t[3]};
        if (t[1] == v) return {t[0], t[3], t[2]};
        if (t[2] == v) return {t[0], t[1], t[3]};
        return {t[0], t[2], t[1]};
    }

    std::vector<link_face> link(idx v) const
    {
        std::vector<link_face> faces;
        for (const idx c : stars_[at(v)]) faces.push_back(opposite(cells_[at(c)], v));
        return faces;
    }

    /// The edges around an open star: with v they are the faces of the boundary there, normals out.
    static std::vector<edge> rim(const std::vector<link_face>& link)
    {
        std::vector<edge> edges;
        for (const auto& [p, q, r] : link)
            for (const edge e : {edge{q, p}, edge{r, q}, edge{p, r}}) edges.push_back(e);
        const auto sorted = [](edge e) { return edge{std::min(e[0], e[1]), std::max(e[0], e[1])}; };
        std::sort(edges.begin(), edges.end(), [&](edge a, edge b) { return sorted(a) < sorted(b); });
        std::size_t left = 0;
        for (std::size_t k = 0; k < edges.size();)
        {
            const bool paired = k + 1 < edges.size() && sorted(edges[k]) == sorted(edges[k + 1]);
            if (!paired) edges[left++] = edges[k];
            k += paired ? 2 : 1;
        }
        edges.resize(left);
        return edges;
    }

    /// link_, ring_ and rim_ of v.
    void look_around(idx v)
    {
        link_ = link(v);
        ++stamp_;
        ring_.clear();
        for (const auto& face : link_)
            for (const idx w : face)
                if (std::exchange(mark_[at(w)], stamp_) != stamp_) ring_.push_back(w);
        rim_ = open_[at(v)] ? rim(link_) : std::vector<edge>();
    }

    bool is_kept(idx v) const { return !kept_.empty() && kept_[at(v)] != 0; }
    bool all_kept(const auto& vertices) const
    {
        return std::all_of(vertices.begin(), vertices.end(), [this](idx v) { return is_kept(v); });
    }

    /// Finds the best target of a collapse of v, or -1.
    idx target(idx v, const volume_collapse_rules& rules) const
    {
        double least = rules.quality;
        for (const auto& [p, q, r] : link_)
            least = std::min(least, 0.9 * tetrahedron_quality(point(v), point(p), point(q), point(r)));
        std::vector<std::pair<double, idx>> good;
        for (const idx u : ring_)
        {
            if (open_[at(v)] && std::none_of(rim_.begin(), rim_.end(), [u](const edge& e) { return has(e, u); }))
                continue;
            const double q = quality(v, u, std::max(least, 0.0));
            if (q > 0) good.emplace_back(q, u);
        }
        std::sort(good.rbegin(), good.rend());
        for (const auto& [q, u] : good)
            if (link_.size() + stars_[at(u)].size() < largest_star && faces_stay(v, u, rules.facing) && is_link(v, u))
                return u;
        return -1;
    }

    /// Worst cell if the star of v is filled from u; 0 where that is not above `enough`, or has a new cell of kept
    /// vertices alone, which no solver could repair.
    double quality(idx v, idx u, double enough) const
    {
        double worst = 1;
        for (const auto& face : link_)
        {
            if (has(face, u)) continue;
            if (!is_kept(v) && is_kept(u) && all_kept(face)) return 0;
            worst = std::min(worst, tetrahedron_quality(point(u), point(face[0]), point(face[1]), point(face[2])));
            if (!(worst > enough)) return 0;
        }
        return worst;
    }

    /// Returns whether no boundary normal turns much.
    bool faces_stay(idx v, idx u, double least) const
    {
        return std::all_of(rim_.begin(), rim_.end(),
                           [&](const edge& e)
                           {
                               if (has(e, u)) return true;
                               const vec3 a = point(e[0]), b = point(e[1]);
                               const vec3 before = glm::cross(a - point(v), b - point(v)),
                                          after = glm::cross(a - point(u), b - point(u));
                               return glm::dot(before, after) > least * glm::length(before) * glm::length(after);
                           });
    }

    /// Link condition: the intersection of the links of v and u is the link of their edge, in the volume and, where v
    /// is on the boundary, there. mark_ has stamp_ at the ring of v.
    bool is_link(idx v, idx u) const
    {
        std::vector<idx> shared;
        std::vector<edge> edges, others; // of v's link between shared vertices: in a cell with u, or not
        const auto sorted = [](idx a, idx b) { return edge{std::min(a, b), std::max(a, b)}; };
        for (const auto& face : link_)
            if (has(face, u))
            {
                edge e{};
                std::size_t n = 0;
                for (const idx w : face)
                {
                    if (w == u) continue;
                    e[n++] = w;
                    if (!has(shared, w)) shared.push_back(w);
                }
                edges.push_back(sorted(e[0], e[1]));
            }
        const auto each_edge = [&](const link_face& face, const auto& visit)
        {
            for (const edge e : {sorted(face[0], face[1]), sorted(face[1], face[2]), sorted(face[0], face[2])})
                if (has(shared, e[0]) && has(shared, e[1]) && !has_edge(edges, e)) visit(e);
        };
        for (const auto& face : link_)
            if (!has(face, u)) each_edge(face, [&](edge e) { others.push_back(e); });
        const auto theirs = link(u);
        bool good = true;
        for (const auto& face : theirs)
        {
            if (has(face, v)) continue;
            for (const idx w : face) good = good && (mark_[at(w)] != stamp_ || has(shared, w));
            if (good) each_edge(face, [&](edge e) { good = good && !has_edge(others, e); });
            if (!good) return false;
        }
        if (!open_[at(v)]) return true;
        std::vector<idx> both; // neighbours of both along the boundary
        for (const edge& e : rim(theirs))
        {
            if (has(e, v)) continue;
            for (const idx w : e)
                if (!has(both, w) && std::any_of(rim_.begin(), rim_.end(), [w](const edge& r) { return has(r, w); }))
                    both.push_back(w);
            if (std::any_of(rim_.begin(), rim_.end(),
                            [&](const edge& r) { return sorted(r[0], r[1]) == sorted(e[0], e[1]); }))
                return false;
        }
        return both.size() <= 2;
    }

    static bool has_edge(const std::vector<edge>& edges, const edge& e)
    {
        return std::find(edges.begin(), edges.end(), e) != edges.end();
    }

    void collapse(idx v, idx u)
    {
        for (const idx c : stars_[at(v)])
        {
            cell& t = cells_[at(c)];
            if (has(t, u))
            {
                for (const idx w : t)
                    if (w != v) std::erase(stars_[at(w)], c);
                t[0] = -1;
                continue;
            }
            std::replace(t.begin(), t.end(), v, u);
            stars_[at(u)].push_back(c);
        }
        stars_[at(v)] = {};
        into_[at(v)] = u;
    }

    std::vector<vec3> points_;
    std::vector<cell> cells_; ///< -1 first: it is gone
    std::vector<char> kept_, open_;
    std::vector<idx> into_;
    std::vector<std::vector<idx>> stars_;

    std::vector<link_face> link_; ///< of the current vertex
    std::vector<idx> ring_;
    std::vector<edge> rim_;
    std::vector<unsigned> mark_; ///< stamp_: in ring_
    unsigned stamp_ = 0;
    std::vector<char> busy_; ///< a neighbour has gone in this round
};

} // namespace taut::impl
