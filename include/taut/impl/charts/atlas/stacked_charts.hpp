// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/atlas_summary.hpp>
#include <taut/impl/charts/atlas/settled_charts.hpp>
#include <taut/impl/charts/packing/outlines.hpp>
#include <taut/impl/core/measure/rigid_motion.hpp>
#include <taut/impl/core/mesh/facets.hpp>
#include <taut/impl/core/mesh/last_digit.hpp>
#include <taut/rigid_motion.hpp>

namespace taut::impl
{

/// Faces of a copy, and those that they are copies of.
struct copied_faces
{
    std::vector<std::pair<idx, idx>> sides; ///< of polygons
    std::vector<idx> vertices;              ///< one per vertex of the copy
    bool same_triangles = true;             ///< polygons are cut along the same diagonals
};

/// Finds charts that are copies of each other in space, turned and moved: the same polygons, whatever their diagonals
/// and numbers, with corners at the same places to within a thousandth of the chart's size or the digits of
/// coordinates.
class copy_search
{
public:
    /// What copies have in common.
    struct traits
    {
        std::array<idx, 3> counts{}; ///< of vertices, sides of polygons, sides of the border
        idx start = 0;               ///< the longest side of a polygon
        double size = 0;             ///< the largest distance of a vertex from the centre
        vec3 centre{0.0};
    };

    /// together: one flag per side of charts.surface, 1 on the diagonals of polygons; or empty. Refers to the charts.
    copy_search(const chart_mesh& charts, std::vector<char> together)
        : charts_(charts),
          facets_(facets(charts.surface)),
          together_(std::move(together)),
          digit_(last_digit(charts.surface.points()))
    {
        for (std::size_t k = 0; k < u(charts.charts()); ++k) traits_.push_back(traits_of(k));
    }

    const traits& of(idx chart) const { return traits_[u(chart)]; }

    /// Returns whether a side is one of a polygon, not of a triangle within.
    bool outer(idx side) const { return together_.empty() || !together_[u(side)] || facets_.twin[u(side)] < 0; }

    /// The vertex where a side begins.
    idx start(idx side) const { return corner(next(side)); }

    /// Finds a copy of chart a in chart b.
    std::optional<copied_faces> find(idx a, idx b) const
    {
        const traits &from = of(a), &to = of(b);
        const double reach = reach_of(from.size);
        if (from.counts != to.counts || std::abs(from.size - to.size) > reach) return {};
        // Symmetric charts have many starts, all of which are good; few of the others go far.
        std::size_t effort = 100 * u(from.counts[1]) + 1000;
        const idx first = 3 * charts_.first_cell[u(b)], count = 3 * size_of(charts_.first_cell, b);
        const idx same = from.start - 3 * charts_.first_cell[u(a)]; // copies are mostly numbered alike
        for (idx i = 0; i < count && effort > 0; ++i)
        {
            const idx t = first + (same + i) % count;
            if (!outer(t) || !alike(from.start, t, reach)) continue;
            auto found = walk(from.start, t, b, reach, effort);
            if (!found || !fits(b, found->vertices, reach)) continue;
            found->same_triangles = same_triangles(a, b, found->vertices);
            return found;
        }
        return {};
    }

private:
    static std::size_t u(idx i) { return static_cast<std::size_t>(i); }
    static idx size_of(std::span<const idx> first, idx k) { return first[u(k) + 1] - first[u(k)]; }
    static idx next(idx side) { return side % 3 == 2 ? side - 2 : side + 1; }

    const vec3& at(idx vertex) const { return charts_.surface.points()[u(vertex)]; }
    idx corner(idx side) const { return charts_.surface.cells()[u(side / 3)][u(side % 3)]; }
    double length(idx side) const { return glm::distance(at(start(side)), at(corner(next(next(side))))); }

    /// How far a corner of a copy may be off: also what the digits of coordinates may change in a place, but little by
    /// the size of a chart.
    double reach_of(double size) const { return std::max(1e-3 * size, std::min(8 * digit_, 1e-2 * size)); }

    /// The next side of the polygon.
    idx after(idx side) const
    {
        idx s = next(side);
        for (idx k = 0; !outer(s) && k < charts_.surface.cell_count(); ++k) s = next(facets_.twin[u(s)]);
        return s;
    }

    /// Returns whether sides may have their ends at the same places.
    bool alike(idx a, idx b, double reach) const { return std::abs(length(a) - length(b)) <= 2 * reach; }

    traits traits_of(std::size_t k) const
    {
        traits t;
        const idx begin = charts_.first_vertex[k], end = charts_.first_vertex[k + 1];
        t.counts[0] = end - begin;
        for (idx v = begin; v < end; ++v) t.centre += at(v) / static_cast<double>(end - begin);
        for (idx v = begin; v < end; ++v) t.size = std::max(t.size, glm::distance(at(v), t.centre));
        double longest = 0;
        for (idx s = 3 * charts_.first_cell[k]; s < 3 * charts_.first_cell[k + 1]; ++s)
        {
            if (!outer(s)) continue;
            ++t.counts[1];
            t.counts[2] += facets_.twin[u(s)] < 0;
            if (!(length(s) > longest)) continue;
            longest = length(s);
            t.start = s;
        }
        return t;
    }

    /// Walks over both charts from these sides, polygon by polygon.
    std::optional<copied_faces> walk(idx from, idx to, idx b, double reach, std::size_t& effort) const
    {
        const idx first = 3 * charts_.first_cell[u(b)], first_vertex = charts_.first_vertex[u(b)];
        std::vector<idx> known(u(3 * size_of(charts_.first_cell, b)), -1); // of sides
        copied_faces made;
        made.vertices.assign(u(size_of(charts_.first_vertex, b)), -1);
        std::vector<std::pair<idx, idx>> open{{from, to}};
        while (!open.empty())
        {
            const auto [begin, end] = open.back();
            open.pop_back();
            if (const idx before = known[u(end - first)]; before >= 0)
            {
                if (before != begin) return {};
                continue;
            }
            idx s = begin, t = end;
            do {
                if (effort == 0) return {};
                --effort;
                idx& own = made.vertices[u(start(t) - first_vertex)];
                if (!alike(s, t, reach) || (own >= 0 && own != start(s)) || known[u(t - first)] >= 0) return {};
                own = start(s);
                known[u(t - first)] = s;
                made.sides.emplace_back(s, t);
                const idx x = facets_.twin[u(s)], y = facets_.twin[u(t)];
                if ((x < 0) != (y < 0)) return {};
                if (x >= 0) open.emplace_back(x, y);
                s = after(s);
                t = after(t);
            } while (s != begin && t != end);
            if (s != begin || t != end) return {};
        }
        if (std::count(made.vertices.begin(), made.vertices.end(), idx(-1)) > 0) return {};
        return made;
    }

    /// Returns whether a motion takes the vertices of chart b to those of chart a.
    bool fits(idx b, std::span<const idx> vertices, double reach) const
    {
        const auto& points = charts_.surface.points();
        const auto own = std::span(points).subspan(u(charts_.first_vertex[u(b)]), vertices.size());
        std::vector<vec3> images;
        for (const idx v : vertices) images.push_back(at(v));
        const auto motion = fit_rigid_motion(own, std::span<const vec3>(images));
        for (std::size_t v = 0; v < images.size(); ++v)
            if (!(glm::distance(motion(own[v]), images[v]) <= reach)) return false;
        return true;
    }

    bool same_triangles(idx a, idx b, std::span<const idx> vertices) const
    {
        if (together_.empty()) return true;
        const auto triangles = [&](idx k, const auto& name)
        {
            std::vector<std::array<idx, 3>> all;
            for (idx c = charts_.first_cell[u(k)]; c < charts_.first_cell[u(k) + 1]; ++c)
            {
                auto t = charts_.surface.cells()[u(c)];
                for (idx& v : t) v = name(v);
                std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
                all.push_back(t);
            }
            std::sort(all.begin(), all.end());
            return all;
        };
        const idx first = charts_.first_vertex[u(b)];
        return triangles(a, [](idx v) { return v; }) == triangles(b, [&](idx v) { return vertices[u(v - first)]; });
    }

    const chart_mesh& charts_;
    facet_table facets_;
    std::vector<char> together_;
    double digit_;
    std::vector<traits> traits_; // one per chart
};

/// Charts that are copies of each other in space, turned and moved, not mirrored. Each copy can lie
/// where the first one lies.
class stacked_charts
{
public:
    /// together: one flag per side of charts.surface, 1 on the diagonals of polygons; groups: a label per chart, which
    /// copies have in common; both may be empty
    stacked_charts(const chart_mesh& charts, std::vector<char> together, std::span<const idx> groups)
        : charts_(&charts),
          twin_(charts.surface.points().size()),
          side_(3 * charts.surface.cells().size()),
          same_triangles_(u(charts.charts()), 1)
    {
        for (std::size_t s = 0; s < side_.size(); ++s) side_[s] = static_cast<idx>(s);
        for (std::size_t v = 0; v < twin_.size(); ++v) twin_[v] = static_cast<idx>(v);
        const copy_search search(charts, std::move(together));
        std::map<std::pair<std::array<idx, 3>, idx>, std::vector<idx>> leaders; // by counts and group
        for (idx k = 0; k < charts.charts(); ++k)
        {
            auto& known = leaders[{search.of(k).counts, groups.empty() ? 0 : groups[u(k)]}];
            const auto same = std::find_if(known.begin(), known.end(),
                                           [&](idx first)
                                           {
                                               const auto found = search.find(first, k);
                                               if (found) take(k, *found);
                                               return found.has_value();
                                           });
            leader_.push_back(same == known.end() ? k : *same);
            if (same == known.end()) known.push_back(k);
        }
        find_leaders();
    }

    /// Charts that are no copies of an earlier one.
    const std::vector<idx>& leaders() const { return leaders_; }
    /// For each chart, the one where it lies: itself, or that which it is a copy of.
    const std::vector<idx>& leader() const { return leader_; }

    /// For each side of charts.surface, that of the chart which it is a copy of, or itself; diagonals of polygons have
    /// none.
    const std::vector<idx>& sides() const { return side_; }

    /// Returns whether the polygons of a copy are cut along the same diagonals.
    bool same_triangles(idx chart) const { return same_triangles_[u(chart)] != 0; }

    /// Flags of charts as those of the first copies are, and 1 where other diagonals are flipped in a map of all
    /// charts.
    std::vector<char> bad_of_all(const std::vector<char>& bad, std::span<const vec2> uv) const
    {
        auto all = of_all(of_leaders(bad));
        for (std::size_t k = 0; k < all.size(); ++k)
            if (!same_triangles_[k] && turned_triangle(*charts_, k, uv) >= 0) all[k] = 1;
        return all;
    }

    /// Leaves alone the copies on which other diagonals are flipped in a map of all charts, one value per vertex, or
    /// distorted by more than `most` and than they are.
    void leave_unlike(std::span<const vec2> uv, double most)
    {
        const ideal_elements<triangle> ideal(charts_->surface);
        std::vector<vec2> shared(uv.begin(), uv.end());
        share(shared);
        for (std::size_t k = 0; k < leader_.size(); ++k)
        {
            const auto energy = [&](std::span<const vec2> map)
            { return area_and_energy(*charts_, k, map, ideal).second; };
            if (same_triangles_[k] ||
                (turned_triangle(*charts_, k, shared) < 0 && energy(shared) <= std::max(most, energy(uv))))
                continue;
            leader_[k] = static_cast<idx>(k);
            for (idx v = charts_->first_vertex[k]; v < charts_->first_vertex[k + 1]; ++v) twin_[u(v)] = v;
            for (idx s = 3 * charts_->first_cell[k]; s < 3 * charts_->first_cell[k + 1]; ++s) side_[u(s)] = s;
        }
        find_leaders();
    }

    /// For each first chart, the least distorted of its copies or itself; others name themselves. same_triangles: only
    /// of those whose polygons are cut along the same diagonals
    std::vector<idx> best(std::span<const double> distortion, bool same_triangles) const
    {
        std::vector<idx> all(leader_.size());
        for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<idx>(k);
        for (std::size_t k = 0; k < all.size(); ++k)
            if (idx& one = all[u(leader_[k])];
                (same_triangles_[k] || !same_triangles) && distortion[k] < distortion[u(one)])
                one = static_cast<idx>(k);
        return all;
    }

    /// Gives each first chart the values of the least distorted of its copies, vertex by vertex.
    template <class T>
    void take_best(std::vector<T>& of_vertices, std::span<const double> distortion) const
    {
        const auto from = best(distortion, true);
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

    void take(idx k, const copied_faces& found)
    {
        std::copy(found.vertices.begin(), found.vertices.end(), twin_.begin() + charts_->first_vertex[u(k)]);
        for (const auto& [s, t] : found.sides) side_[u(t)] = s;
        same_triangles_[u(k)] = found.same_triangles;
    }

    void find_leaders()
    {
        leaders_.clear();
        for (std::size_t k = 0; k < leader_.size(); ++k)
            if (u(leader_[k]) == k) leaders_.push_back(static_cast<idx>(k));
    }

    const chart_mesh* charts_;
    std::vector<idx> twin_;            // of each vertex, that of the first chart
    std::vector<idx> side_;            // of each side, that of the first chart
    std::vector<char> same_triangles_; // one per chart
    std::vector<idx> leader_, leaders_;
};

} // namespace taut::impl
