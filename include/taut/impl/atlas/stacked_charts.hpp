// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/atlas/chart_mesh.hpp>
#include <taut/impl/mesh/facets.hpp>
#include <taut/impl/packing/outlines.hpp>

namespace taut::impl
{

/// Charts that are copies of each other in space: the same triangles with the same edge lengths, to within 1e-4, turned
/// and moved, not mirrored. Each copy can lie where the first one lies.
class stacked_charts
{
public:
    /// groups: a label per chart, which copies have in common; or empty
    stacked_charts(const chart_mesh& charts, std::span<const idx> groups)
        : charts_(&charts),
          facets_(facets(charts.surface)),
          twin_(charts.surface.points().size()),
          side_(3 * charts.surface.cells().size())
    {
        for (std::size_t s = 0; s < side_.size(); ++s) side_[s] = static_cast<idx>(s);
        for (std::size_t v = 0; v < twin_.size(); ++v) twin_[v] = static_cast<idx>(v);
        std::map<std::array<idx, 4>, std::vector<idx>>
            leaders; // by numbers of triangles, vertices, border sides; group
        for (idx k = 0; k < charts.charts(); ++k)
        {
            auto& known = leaders[{size_of(charts.first_cell, k), size_of(charts.first_vertex, k), border(k).second,
                                   groups.empty() ? 0 : groups[u(k)]}];
            const auto same = std::find_if(known.begin(), known.end(), [&](idx first) { return match(first, k); });
            leader_.push_back(same == known.end() ? k : *same);
            if (same == known.end())
            {
                known.push_back(k);
                leaders_.push_back(k);
            }
        }
    }

    /// Charts that are no copies of an earlier one.
    const std::vector<idx>& leaders() const { return leaders_; }
    /// For each chart, the one where it lies: itself, or that which it is a copy of.
    const std::vector<idx>& leader() const { return leader_; }

    /// For each side of charts.surface, that of the chart which it is a copy of, or itself.
    const std::vector<idx>& sides() const { return side_; }

    /// For each first chart, the least distorted of its copies or itself; others name themselves.
    std::vector<idx> best(std::span<const double> distortion) const
    {
        std::vector<idx> all(leader_.size());
        for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<idx>(k);
        for (std::size_t k = 0; k < all.size(); ++k)
            if (idx& one = all[u(leader_[k])]; distortion[k] < distortion[u(one)]) one = static_cast<idx>(k);
        return all;
    }

    /// Gives each first chart the values of the least distorted of its copies, vertex by vertex.
    template <class T>
    void take_best(std::vector<T>& of_vertices, std::span<const double> distortion) const
    {
        const auto from = best(distortion);
        for (const idx leader : leaders_)
            if (const auto k = u(from[u(leader)]); k != u(leader))
                for (auto v = u(charts_->first_vertex[k]); v < u(charts_->first_vertex[k + 1]); ++v)
                    of_vertices[u(twin_[v])] = of_vertices[v];
    }

    /// Gives copies the values of those that they are copies of, vertex by vertex.
    template <class T>
    void share(std::vector<T>& of_vertices) const
    {
        for (std::size_t v = 0; v < twin_.size(); ++v) of_vertices[v] = of_vertices[u(twin_[v])];
    }

    /// Values of the first charts alone, and what is known of these for all charts.
    template <class T>
    std::vector<T> of_leaders(const std::vector<T>& all) const
    {
        std::vector<T> some;
        if (!all.empty())
            for (const idx k : leaders_) some.push_back(all[u(k)]);
        return some;
    }
    template <class T>
    std::vector<T> of_all(const std::vector<T>& of_leaders) const
    {
        std::vector<T> all;
        for (const idx k : leader_)
            all.push_back(of_leaders[static_cast<std::size_t>(std::lower_bound(leaders_.begin(), leaders_.end(), k) -
                                                              leaders_.begin())]);
        return all;
    }

    /// Those of the first charts alone.
    chart_outlines first_outlines(const chart_outlines& all) const
    {
        chart_outlines some;
        some.turned = all.turned;
        some.first.push_back(0);
        for (const idx k : leaders_)
        {
            const auto begin = all.first[u(k)], end = all.first[u(k) + 1];
            some.edges.insert(some.edges.end(), all.edges.begin() + begin, all.edges.begin() + end);
            some.cells.insert(some.cells.end(), all.cells.begin() + begin, all.cells.begin() + end);
            some.first.push_back(static_cast<idx>(some.edges.size()));
            some.areas.push_back(all.areas[u(k)]);
        }
        return some;
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }
    static idx size_of(std::span<const idx> first, idx k) { return first[u(k) + 1] - first[u(k)]; }

    idx corner(idx side) const { return charts_->surface.cells()[u(side / 3)][u(side % 3)]; }
    static idx next(idx side) { return side % 3 == 2 ? side - 2 : side + 1; }
    double length(idx side) const
    {
        const auto& x = charts_->surface.points();
        return glm::length(x[u(corner(next(side)))] - x[u(corner(next(next(side))))]);
    }
    bool alike(idx a, idx b) const
    {
        const double x = length(a), y = length(b);
        return std::abs(x - y) <= 1e-4 * std::max(x, y);
    }

    /// The first side of a chart's border, or of a closed one, and the number of those of the border.
    std::pair<idx, idx> border(idx k) const
    {
        idx first = -1, count = 0;
        for (idx s = 3 * charts_->first_cell[u(k)]; s < 3 * charts_->first_cell[u(k) + 1]; ++s)
            if (facets_.twin[u(s)] < 0)
            {
                if (first < 0) first = s;
                ++count;
            }
        return {first < 0 ? 3 * charts_->first_cell[u(k)] : first, count};
    }

    /// Finds a copy of chart a in chart b, and notes its vertices.
    bool match(idx a, idx b)
    {
        const idx begin = border(a).first;
        for (idx s = 3 * charts_->first_cell[u(b)]; s < 3 * charts_->first_cell[u(b) + 1]; ++s)
            if ((facets_.twin[u(s)] < 0) == (facets_.twin[u(begin)] < 0) && alike(begin, s) && walk(begin, s, b))
                return true;
        return false;
    }

    /// Walks over both charts from these sides, triangle by triangle.
    bool walk(idx from, idx to, idx b)
    {
        std::vector<idx> cell(u(size_of(charts_->first_cell, b)), -1), vertex(u(size_of(charts_->first_vertex, b)), -1);
        std::vector<std::pair<idx, idx>> open{{from, to}}, sides;
        while (!open.empty())
        {
            auto [s, t] = open.back();
            open.pop_back();
            idx& known = cell[u(t / 3 - charts_->first_cell[u(b)])];
            if (known >= 0)
            {
                if (known != s / 3) return false;
                continue;
            }
            known = s / 3;
            for (int k = 0; k < 3; ++k, s = next(s), t = next(t))
            {
                idx& own = vertex[u(corner(t) - charts_->first_vertex[u(b)])];
                if (!alike(s, t) || (own >= 0 && own != corner(s))) return false;
                own = corner(s);
                sides.emplace_back(s, t);
                const idx x = facets_.twin[u(s)], y = facets_.twin[u(t)];
                if ((x < 0) != (y < 0)) return false;
                if (x >= 0) open.emplace_back(x, y);
            }
        }
        if (std::count(vertex.begin(), vertex.end(), idx{-1}) > 0) return false;
        for (std::size_t v = 0; v < vertex.size(); ++v) twin_[u(charts_->first_vertex[u(b)]) + v] = vertex[v];
        for (const auto& [s, t] : sides) side_[u(t)] = s;
        return true;
    }

    const chart_mesh* charts_;
    facet_table facets_;
    std::vector<idx> twin_; // of each vertex, that of the first chart
    std::vector<idx> side_; // of each side, that of the first chart
    std::vector<idx> leader_, leaders_;
};

} // namespace taut::impl
