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

#include <taut/impl/charts/atlas/seams/seam_arcs.hpp>
#include <taut/impl/charts/atlas/seams/seam_factors.hpp>
#include <taut/impl/core/core/budget.hpp>
#include <taut/impl/core/core/disjoint_sets.hpp>

namespace taut::impl
{

/// How far seams may be moved.
struct straighten_reach
{
    double distance = std::numeric_limits<double>::infinity(); ///< along edges, from where an arc was, and back
    double least_length =
        0.6; ///< of an arc by that before: less than jags are worth is a short cut, and leads elsewhere
};

/// Moves seams to shorter ways between the nodes at which they end, near where they were. What lies beside an arc stays
/// as it is connected: the way leads through the inside of the two charts there, which are one disk without the arc, or
/// through the one chart that has it on both sides.
class straightening
{
public:
    /// m: oriented; f: its facets. seam: one flag a side; kept: seams that stay where they are, or empty; together:
    /// edges that no way leads along, or empty; weight: what a seam along each side counts
    straightening(const mesh<triangle>& m, const facet_table& f, std::vector<char>& seam, std::span<const char> kept,
                  std::span<const char> together, std::vector<double> weight, const straighten_reach& reach)
        : mesh_(m),
          facets_(f),
          seam_(seam),
          kept_(kept),
          together_(together),
          sides_(starting_sides(m)),
          weight_(std::move(weight)),
          reach_(reach),
          chart_(m.cells().size()),
          on_seam_(m.points().size(), 0),
          ring_(m.points().size(), -1),
          away_(m.points().size(), 0),
          distance_(m.points().size(), infinite),
          came_(m.points().size(), -1)
    {
        disjoint_sets parts(m.cell_count());
        for (std::size_t s = 0; s < seam.size(); ++s)
            if (f.twin[s] >= 0 && !seam[s]) parts.join(static_cast<idx>(s) / 3, f.twin[s] / 3);
        for (std::size_t c = 0; c < chart_.size(); ++c) chart_[c] = parts.find(static_cast<idx>(c));
        for (std::size_t s = 0; s < seam.size(); ++s)
            if (f.twin[s] < 0 || seam[s])
                for (const idx v : side_vertices(m, static_cast<idx>(s))) on_seam_[u(v)] = 1;
    }

    /// limits: asked periodically; once it refuses, the other seams are kept
    void run(budget& limits)
    {
        // Piece by piece, since the shortest way between the ends of a long arc may be another one altogether: around
        // the foot of a finger instead of over its tip. Then again, where pieces met.
        constexpr std::size_t piece = 24;
        for (const std::size_t first : {piece, piece / 2})
        {
            const csr arcs = seam_arcs(mesh_, facets_, sides_, seam_);
            for (idx a = 0; a < arcs.rows(); ++a)
            {
                if (a % 256 == 0 && !limits.proceed()) return;
                const auto arc = arcs.row(a);
                for (std::size_t begin = 0, end = std::min(first, arc.size()); begin < end;
                     begin = end, end = std::min(end + piece, arc.size()))
                    straighten(arc.subspan(begin, end - begin));
            }
        }
    }

private:
    static constexpr double infinite = std::numeric_limits<double>::infinity();

    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    idx end_of(idx side) const { return first_vertex(mesh_, facets_.twin[u(side)]); }

    void straighten(std::span<const idx> arc)
    {
        const auto is_kept = [&](idx s) { return !kept_.empty() && kept_[u(s)]; };
        if (arc.size() < 2 || std::any_of(arc.begin(), arc.end(), is_kept)) return;
        const idx from = first_vertex(mesh_, arc.front()), to = end_of(arc.back());
        left_ = chart_[u(arc.front() / 3)];
        right_ = chart_[u(facets_.twin[u(arc.front())] / 3)];

        double before = 0;
        for (const idx s : arc) before += weight_[u(s)];
        set_seam(arc, 0);
        for (std::size_t i = 1; i < arc.size(); ++i) on_seam_[u(first_vertex(mesh_, arc[i]))] = 0;
        gather_band(arc, to);
        const auto starts = sector(arc.front()), ends = sector(facets_.twin[u(arc.back())]);
        const double after = find_way(from, to, starts, ends);
        std::vector<idx> way;
        if (after < (1 - 1e-9) * before)
            for (idx v = to; way.empty() || v != from; v = first_vertex(mesh_, way.back())) way.push_back(came_[u(v)]);
        std::reverse(way.begin(), way.end());
        const bool gains = !way.empty() && length(way) > reach_.least_length * length(arc) && stays_near(arc, way);
        if (!gains) way.assign(arc.begin(), arc.end());
        for (const idx v : band_)
        {
            ring_[u(v)] = came_[u(v)] = -1;
            distance_[u(v)] = infinite;
        }
        set_seam(way, 1);
        for (std::size_t i = 1; i < way.size(); ++i) on_seam_[u(first_vertex(mesh_, way[i]))] = 1;
        if (gains && left_ != right_) relabel(way);
    }

    double length(std::span<const idx> arc) const
    {
        double sum = 0;
        for (const idx s : arc)
            sum += glm::distance(mesh_.points()[u(first_vertex(mesh_, s))], mesh_.points()[u(end_of(s))]);
        return sum;
    }

    /// Whether all vertices of an arc lie within reach of a way: one of few long edges would leave out corners.
    bool stays_near(std::span<const idx> arc, std::span<const idx> way) const
    {
        if (!(reach_.distance < infinite)) return true;
        const auto is_near = [&](idx corner)
        {
            const vec3 p = mesh_.points()[u(corner)];
            return std::any_of(way.begin(), way.end(),
                               [&](idx s)
                               {
                                   const vec3 a = mesh_.points()[u(first_vertex(mesh_, s))];
                                   const vec3 d = mesh_.points()[u(end_of(s))] - a;
                                   const double t = glm::dot(p - a, d) / std::max(glm::dot(d, d), 1e-300);
                                   return glm::distance(p, a + std::clamp(t, 0.0, 1.0) * d) <= reach_.distance;
                               });
        };
        return std::all_of(arc.begin(), arc.end(), [&](idx s) { return is_near(first_vertex(mesh_, s)); });
    }

    void set_seam(std::span<const idx> arc, char value)
    {
        for (const idx s : arc) seam_[u(s)] = seam_[u(facets_.twin[u(s)])] = value;
    }

    /// Returns whether an edge runs through the inside of the charts beside the arc.
    bool inside(idx side) const
    {
        const idx t = facets_.twin[u(side)];
        if (t < 0 || seam_[u(side)]) return false;
        const idx a = chart_[u(side / 3)], b = chart_[u(t / 3)];
        return (a == left_ || a == right_) && (b == left_ || b == right_);
    }

    /// Edges around the start of a side, up to the next seams.
    std::vector<idx> sector(idx side) const
    {
        const auto turned = [](idx s, idx by) { return s / 3 * 3 + (s + by) % 3; };
        std::vector<idx> result{side};
        for (idx s = side;;)
        {
            const idx p = turned(s, 2), t = facets_.twin[u(p)];
            if (t < 0 || seam_[u(p)] || t == side) break;
            result.push_back(s = t);
        }
        for (idx s = side;;)
        {
            const idx n = turned(facets_.twin[u(s)], 1);
            if (facets_.twin[u(n)] < 0 || seam_[u(n)] || n == side) break;
            result.push_back(s = n);
        }
        return result;
    }

    /// Vertices within some rings of an arc that a path may use, and its ends.
    void gather_band(std::span<const idx> arc, idx to)
    {
        constexpr idx rings = 3; // of triangles: seams that lead over the tip of a finger are to stay there
        band_.clear();
        const auto add = [&](idx v, idx ring, double away)
        {
            if (away > reach_.distance) return;
            ring_[u(v)] = ring;
            away_[u(v)] = away;
            band_.push_back(v);
        };
        for (const idx s : arc)
            if (ring_[u(first_vertex(mesh_, s))] < 0) add(first_vertex(mesh_, s), 0, 0);
        if (ring_[u(to)] < 0) add(to, 0, 0);
        for (std::size_t i = 0; i < band_.size(); ++i)
        {
            const idx v = band_[i];
            if (ring_[u(v)] == rings) continue;
            for (const idx s : sides_.row(v))
            {
                if (!inside(s)) continue;
                const idx w = end_of(s);
                if (ring_[u(w)] < 0 && !on_seam_[u(w)])
                    add(w, ring_[u(v)] + 1, away_[u(v)] + glm::distance(mesh_.points()[u(v)], mesh_.points()[u(w)]));
            }
        }
    }

    /// Runs Dijkstra's algorithm in the band, from one of the sides `starts` to the start of one of `ends`.
    double find_way(idx from, idx to, std::span<const idx> starts, std::span<const idx> ends)
    {
        using entry = std::pair<double, idx>;
        std::priority_queue<entry, std::vector<entry>, std::greater<>> queue;
        const auto leave = [&](double here, std::span<const idx> sides)
        {
            for (const idx s : sides)
            {
                const idx w = end_of(s);
                if (!inside(s) || ring_[u(w)] < 0 || w == from || (!together_.empty() && together_[u(s)] != 0))
                    continue;
                if (w == to && std::find(ends.begin(), ends.end(), facets_.twin[u(s)]) == ends.end()) continue;
                if (const double there = here + weight_[u(s)]; there < distance_[u(w)])
                {
                    distance_[u(w)] = there;
                    came_[u(w)] = s;
                    queue.emplace(there, w);
                }
            }
        };
        if (from == to) return infinite; // a loop stays
        leave(0, starts);
        while (!queue.empty())
        {
            const auto [here, v] = queue.top();
            queue.pop();
            if (v == to) return here;
            if (here == distance_[u(v)]) leave(here, sides_.row(v));
        }
        return infinite;
    }

    /// Moves triangles between an old and a new path to the other chart.
    void relabel(std::span<const idx> way)
    {
        std::vector<idx> front;
        const auto paint = [&](idx c, idx colour)
        {
            if (chart_[u(c)] == colour) return;
            chart_[u(c)] = colour;
            front.push_back(c);
        };
        const auto flood = [&](idx colour)
        {
            while (!front.empty())
            {
                const idx c = front.back();
                front.pop_back();
                for (idx s = 3 * c; s < 3 * c + 3; ++s)
                    if (const idx t = facets_.twin[u(s)]; t >= 0 && !seam_[u(s)]) paint(t / 3, colour);
            }
        };
        for (const idx s : way) paint(s / 3, left_);
        flood(left_);
        for (const idx s : way) paint(facets_.twin[u(s)] / 3, right_);
        flood(right_);
    }

    const mesh<triangle>& mesh_;
    const facet_table& facets_;
    std::vector<char>& seam_;
    std::span<const char> kept_, together_;
    csr sides_;
    std::vector<double> weight_; // one a side
    straighten_reach reach_;
    std::vector<idx> chart_;    // one a triangle
    std::vector<char> on_seam_; // one a vertex, or on the boundary
    std::vector<idx> ring_;     // one a vertex of the band, else -1
    std::vector<double> away_;  // from the arc, one a vertex of the band
    std::vector<double> distance_;
    std::vector<idx> came_; // the side by which the way leads to a vertex
    std::vector<idx> band_;
    idx left_ = 0, right_ = 0;
};

/// Straightens seams in place, as many as the budget allows. weight: one a side, or empty for seam_weights()
inline void straighten(const mesh<triangle>& m, const facet_table& f, std::vector<char>& seam,
                       std::span<const char> kept, std::span<const char> together, budget& limits,
                       std::vector<double> weight = {}, const straighten_reach& reach = {})
{
    if (weight.empty()) weight = seam_weights(m, f);
    straightening(m, f, seam, kept, together, std::move(weight), reach).run(limits);
}

} // namespace taut::impl
