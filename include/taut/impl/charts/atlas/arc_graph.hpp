// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <taut/impl/core/core/disjoint_sets.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Surface as polygons glued along arcs: at first its triangles, and a polygon in each hole, so that it is closed; then
/// their unions as arcs are removed. Every polygon is a disk at all times, since an arc is removed only between
/// different polygons, which are united, or if it has a free end inside its polygon.
///
/// A half arc h runs along a chain of edges with its polygon to the left, and twin(h) is the same chain the other way.
/// Half arcs are numbered as the sides of the triangles, those of the holes behind them. All operations take constant
/// time but for the unions of polygons.
class arc_graph
{
public:
    /// m: oriented; f: its facets
    arc_graph(const mesh<triangle>& m, const facet_table& f)
        : next_(f.twin.size()), prev_(f.twin.size()), twin_(f.twin), polygon_(f.twin.size()), sets_(0)
    {
        const idx sides = static_cast<idx>(f.twin.size());
        for (idx s = 0; s < sides; ++s)
        {
            polygon_[u(s)] = s / 3;
            link(s, s % 3 == 2 ? s - 2 : s + 1);
        }
        idx polygons = m.cell_count();
        for (idx first = 0; first < sides; ++first) // the rim of a hole runs against its sides
        {
            if (twin_[u(first)] >= 0) continue;
            idx s = first, last = -1;
            const idx opening = static_cast<idx>(next_.size());
            do {
                const auto h = static_cast<idx>(next_.size());
                next_.push_back(last);
                prev_.push_back(-1);
                twin_.push_back(s);
                polygon_.push_back(polygons);
                twin_[u(s)] = h;
                if (last >= 0) prev_[u(last)] = h;
                last = h;
                s = next_boundary_side(f, s);
            } while (s != first);
            link(opening, last);
            ++polygons;
        }
        sets_ = disjoint_sets(polygons);
        polygons_ = polygons;

        // A node for each fan of triangles, so that parts that touch in a vertex do not meet there.
        node_.assign(next_.size(), -1);
        for (idx h = 0; h < half_arcs(); ++h)
        {
            if (node_[u(h)] >= 0) continue;
            const auto node = static_cast<idx>(degree_.size());
            degree_.push_back(0);
            for (idx k = h; node_[u(k)] < 0; k = twin_[u(prev_[u(k)])])
            {
                node_[u(k)] = node;
                ++degree_[u(node)];
            }
        }
    }

    idx half_arcs() const { return static_cast<idx>(next_.size()); }
    idx nodes() const { return static_cast<idx>(degree_.size()); }
    idx polygons() const { return polygons_; } ///< at first: triangles, then holes
    idx next(idx h) const { return next_[u(h)]; }
    idx prev(idx h) const { return prev_[u(h)]; }
    idx twin(idx h) const { return twin_[u(h)]; }
    idx start(idx h) const { return node_[u(h)]; } ///< the node that h runs from
    idx degree(idx node) const { return degree_[u(node)]; }
    idx polygon(idx h) { return sets_.find(polygon_[u(h)]); } ///< to the left
    bool alive(idx h) const { return next_[u(h)] >= 0; }
    idx arc(idx h) const { return std::min(h, twin_[u(h)]); } ///< one number for both directions

    /// Returns whether h has a free end inside its polygon, and is not its whole boundary.
    bool dangles(idx h) const { return next_[u(h)] == twin_[u(h)] && prev_[u(h)] != twin_[u(h)]; }

    /// Returns whether the polygons beside h differ and have further sides, so that they may be united.
    bool parts(idx h)
    {
        const idx t = twin_[u(h)];
        return polygon(h) != polygon(t) && !(next_[u(h)] == h && next_[u(t)] == t);
    }

    /// Single arc that bounds a polygon after the removal of h, or -1 if there are more.
    idx last_without(idx h) const
    {
        const idx t = twin_[u(h)], g = next_[u(h)];
        if (next_[u(g)] == h && next_[u(t)] == twin_[u(g)] && prev_[u(t)] == twin_[u(g)]) return arc(g);
        const idx x = dangles(h) ? next_[u(t)] : g; // of a slit: what follows it
        const bool slit = dangles(h) || dangles(t);
        return slit && next_[u(x)] == twin_[u(x)] && next_[u(twin_[u(x)])] == (dangles(h) ? h : t) ? arc(x) : -1;
    }

    /// Returns whether two arcs meet at the start of h, and nothing else.
    bool passes(idx h) const { return degree(start(h)) == 2 && arc(prev_[u(h)]) != arc(h); }

    /// Removes an arc that separates two polygons, or that dangles. Returns the half arcs that now start where it
    /// started and ended, or -1 where there is none.
    std::array<idx, 2> remove(idx h)
    {
        const idx t = twin_[u(h)];
        const idx before = prev_[u(h)], beyond = next_[u(h)], before_twin = prev_[u(t)], beyond_twin = next_[u(t)];
        if (polygon(h) != polygon(t)) sets_.join(polygon_[u(h)], polygon_[u(t)]);
        --degree_[u(start(h))];
        --degree_[u(start(t))];
        next_[u(h)] = next_[u(t)] = -1;
        if (beyond == t) return {link(before, beyond_twin), -1};
        if (beyond_twin == h) return {-1, link(before_twin, beyond)};
        if (beyond == h) return {link(before_twin, beyond_twin), -1};
        if (beyond_twin == t) return {link(before, beyond), -1};
        return {link(before, beyond_twin), link(before_twin, beyond)};
    }

    /// Joins the two arcs at the start of h, whose half arcs are prev(h) and its twin.
    void join_at_start(idx h)
    {
        const idx p = prev_[u(h)], t = twin_[u(h)], q = twin_[u(p)];
        --degree_[u(start(h))];
        --degree_[u(start(h))];
        node_[u(q)] = node_[u(t)];
        const idx beyond = next_[u(h)], before = prev_[u(t)];
        next_[u(h)] = next_[u(t)] = -1;
        link(p, beyond == t ? q : beyond);
        if (beyond != t) link(before, q);
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    idx link(idx a, idx b)
    {
        next_[u(a)] = b;
        prev_[u(b)] = a;
        return b;
    }

    std::vector<idx> next_, prev_, twin_, node_, polygon_, degree_;
    disjoint_sets sets_;
    idx polygons_ = 0;
};

} // namespace taut::impl
