// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/charts/packing/outlines.hpp>
#include <taut/impl/core/core/csr.hpp>
#include <taut/impl/core/core/disjoint_sets.hpp>
#include <taut/impl/core/exact/crossings.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Overlaps of charts.
struct chart_overlaps
{
    std::size_t pairs = 0;            ///< pairs of charts with an area in common
    bool all = true;                  ///< false: there are at least so many
    std::array<idx, 2> first{-1, -1}; ///< charts of the first pair that was found
};

/// True if the interiors of two triangles have a common point; exact. For either orientation.
inline bool interiors_meet(std::array<vec2, 3> t, std::array<vec2, 3> s)
{
    for (auto* k : {&t, &s})
    {
        const int sign = orient2d((*k)[0], (*k)[1], (*k)[2]);
        if (sign == 0) return false;
        if (sign < 0) std::swap((*k)[1], (*k)[2]);
    }
    // Convex sets without a common inner point are parted by the line of a side of one of them.
    const auto parted = [](const std::array<vec2, 3>& a, const std::array<vec2, 3>& b)
    {
        for (std::size_t k = 0; k < 3; ++k)
            if (std::all_of(b.begin(), b.end(), [&](const vec2& p) { return orient2d(a[k], a[(k + 1) % 3], p) <= 0; }))
                return true;
        return false;
    };
    return !parted(t, s) && !parted(s, t);
}

/// Search for overlapping charts, each pair counted once.
class overlap_search
{
public:
    overlap_search(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells, const chart_outlines& outlines,
                   std::size_t most)
        : uv_(uv),
          cells_(cells),
          outlines_(outlines),
          chart_(outlines.edges.size()),
          most_(most),
          tests_(64 * outlines.edges.size() + 10 * most)
    {
        for (idx c = 0; c < outlines.charts(); ++c)
            std::fill(chart_.begin() + outlines.first[u(c)], chart_.begin() + outlines.first[u(c) + 1], c);
    }

    std::span<const idx> chart_of_edge() const { return chart_; }

    /// Charts whose borders meet.
    void crossing(const edge_tree& tree)
    {
        tree.for_each_pair(
            [&](std::size_t i, std::size_t j)
            { return spend() && (!edges_meet(outlines_.edges[i], outlines_.edges[j], uv_) || look(i, j)); });
    }

    /// Finds charts inside of others: one point of each connected part of a border is located.
    void nested(const edge_tree& tree)
    {
        const auto within = [&](idx inner, idx outer)
        {
            const idx border = outlines_.first[u(outer)];
            const edge_box& box = tree.box_of_group(border);
            tree.for_each_in_group(outlines_.first[u(inner)], box,
                                   [&](std::size_t e)
                                   {
                                       const vec2& p = uv_[u(outlines_.edges[e][0])];
                                       if (!begins_part(e) || !box.meets({p, p})) return true;
                                       int sum = 0; // the winding number
                                       tree.for_each_in_group(border, {p, {p.x, box.high.y}},
                                                              [&](std::size_t i)
                                                              {
                                                                  sum += crossing_above(p, i);
                                                                  return spend();
                                                              });
                                       if (found_.all && sum > 0 && sum < through / 2) add(inner, outer);
                                       return found_.all;
                                   });
        };
        tree.for_each_pair_of_groups(
            [&](idx g, idx h)
            {
                within(g, h);
                within(h, g);
                return spend();
            });
    }

    const chart_overlaps& found() const { return found_; }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }

    bool spend()
    {
        if (tests_ == 0 || found_.pairs >= most_) return found_.all = false;
        --tests_;
        return true;
    }

    bool known(idx a, idx b) const { return pairs_.contains(key(a, b)); }
    static std::uint64_t key(idx a, idx b)
    {
        return static_cast<std::uint64_t>(std::min(a, b)) << 32U | static_cast<std::uint64_t>(std::max(a, b));
    }
    void add(idx a, idx b)
    {
        if (!pairs_.insert(key(a, b)).second) return;
        if (found_.pairs++ == 0) found_.first = {std::min(a, b), std::max(a, b)};
    }

    /// Edges that have a point in common: charts overlap if triangles there do, and only then where they are injective.
    bool look(std::size_t i, std::size_t j)
    {
        if (known(chart_[i], chart_[j])) return true;
        if (cells_of_vertex_.rows() < 0) find_cells();
        for (const idx s : around(i))
            for (const idx t : around(j))
                if (interiors_meet(corners(s), corners(t)))
                {
                    add(chart_[i], chart_[j]);
                    return true;
                }
        return true;
    }

    std::vector<idx> around(std::size_t edge) const
    {
        std::vector<idx> at{outlines_.cells[edge]};
        for (const idx v : outlines_.edges[edge])
            for (const idx t : cells_of_vertex_.row(v)) at.push_back(t);
        return at;
    }

    std::array<vec2, 3> corners(idx t) const
    {
        const auto& c = cells_[u(t)];
        return {uv_[u(c[0])], uv_[u(c[1])], uv_[u(c[2])]};
    }

    /// Returns whether an edge begins in the smallest vertex of a connected part of a border, as one of each part does.
    bool begins_part(std::size_t edge)
    {
        if (begins_part_.empty())
        {
            disjoint_sets parts(static_cast<idx>(uv_.size()));
            for (const auto& [a, b] : outlines_.edges) parts.join(a, b);
            for (const auto& [a, b] : outlines_.edges) begins_part_.push_back(parts.find(a) == a);
        }
        return begins_part_[edge] != 0;
    }

    void find_cells()
    {
        auto& [offsets, items] = cells_of_vertex_;
        offsets.assign(uv_.size() + 2, 0);
        for (const auto& cell : cells_)
            for (const idx v : cell) ++offsets[u(v) + 2];
        for (std::size_t v = 2; v < offsets.size(); ++v) offsets[v] += offsets[v - 1];
        items.resize(3 * cells_.size());
        for (std::size_t t = 0; t < cells_.size(); ++t)
            for (const idx v : cells_[t]) items[u(offsets[u(v) + 1]++)] = static_cast<idx>(t);
        offsets.pop_back();
    }

    static constexpr int through = 1 << 20; ///< more than any winding number

    /// Contribution of an edge to the winding number about p, by the ray upwards; `through` if it contains p: touching
    /// charts are checked elsewhere.
    int crossing_above(const vec2& p, std::size_t edge) const
    {
        const vec2 &a = uv_[u(outlines_.edges[edge][0])], &b = uv_[u(outlines_.edges[edge][1])];
        const int side = orient2d(a, b, p);
        if (side == 0 && between(a, b, p)) return through;
        if ((a.x <= p.x) == (b.x <= p.x)) return 0;
        if (b.x <= p.x) return side > 0 ? 1 : 0;
        return side < 0 ? -1 : 0;
    }

    std::span<const vec2> uv_;
    std::span<const std::array<idx, 3>> cells_;
    const chart_outlines& outlines_;
    std::vector<idx> chart_; // of each edge
    std::size_t most_, tests_;
    std::unordered_set<std::uint64_t> pairs_;
    csr cells_of_vertex_;           // empty until charts touch
    std::vector<char> begins_part_; // one per edge; empty until boxes of charts meet
    chart_overlaps found_;
};

/// Finds pairs of charts whose images overlap, in any atlas: O(n log n) where few do. Charts that touch along edges or
/// in points do not count, nor does a chart in the hole of another. Exact for charts that are injective; of one that is
/// folded, the union of its triangles counts. Ends at `most` pairs, or at a limit of work.
///
/// uv, cells, first_cell, first_vertex: as for pack()
/// Throws packing_error.
inline chart_overlaps find_chart_overlaps(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells,
                                          std::span<const idx> first_cell, std::span<const idx> first_vertex,
                                          std::size_t most = 100'000)
{
    impl::check_charts(uv, cells, first_cell, first_vertex);
    const auto outlines = impl::find_outlines(uv, cells, first_cell, first_vertex);
    impl::overlap_search search(uv, cells, outlines, most);
    const impl::edge_tree tree(outlines.edges, uv, outlines.first);
    search.crossing(tree);
    search.nested(tree);
    return search.found();
}

} // namespace taut::impl
