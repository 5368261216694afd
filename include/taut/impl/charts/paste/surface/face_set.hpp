// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/facets.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/paste.hpp>

namespace taut::impl
{

/// Set of triangles of a surface, with tests and corrections of its topology. It refers to the surface and its facets.
class face_set
{
public:
    /// Throws mesh_error unless the surface is manifold along edges and oriented.
    face_set(const mesh<triangle>& m, const facet_table& sides) : m_(&m), sides_(&sides), has_(m.cells().size(), 0)
    {
        if (!sides.manifold())
            throw mesh_error(
                mesh_error::non_manifold_facet, {sides.crowds[0].begin(), sides.crowds[0].end()},
                "an edge of the surface has three or more triangles; `taut check` lists them, repair them");
        if (!sides.oriented())
            throw mesh_error(mesh_error::inconsistent_orientation, {sides.clash[0][0] / 3, sides.clash[0][1] / 3},
                             "neighbours are oriented differently; turn one of each pair over");
    }

    /// Returns whether it was not there.
    bool add(idx f) { return !std::exchange(has_[static_cast<std::size_t>(f)], char(1)); }
    bool has(idx f) const { return has_[static_cast<std::size_t>(f)] != 0; }

    std::vector<idx> faces() const
    {
        std::vector<idx> result;
        for (std::size_t f = 0; f < has_.size(); ++f)
            if (has_[f]) result.push_back(static_cast<idx>(f));
        return result;
    }

    /// The triangle across side s, or -1.
    idx across(idx s) const
    {
        const idx twin = sides_->twin[static_cast<std::size_t>(s)];
        return twin < 0 ? -1 : twin / 3;
    }

    /// One triangle of each part that hangs together along edges.
    std::vector<idx> first_of_components() const
    {
        std::vector<idx> first;
        label(1, [&](idx f, std::size_t) { first.push_back(f); });
        return first;
    }

    /// Keeps only the part of triangle f.
    void keep_component(idx f)
    {
        const auto part = label(1, [](idx, std::size_t) {});
        for (std::size_t g = 0; g < has_.size(); ++g)
            if (has_[g] && part[g] != part[static_cast<std::size_t>(f)]) has_[g] = 0;
    }

    /// Adds each part of the rest that the set encloses, all but the largest one that it touches, where that has fewer
    /// triangles than the set. Returns whether there was any.
    bool fill_holes()
    {
        std::vector<std::size_t> sizes;
        const auto part = label(0, [&](idx, std::size_t n) { sizes.push_back(n); });
        std::vector<char> touched(sizes.size(), 0);
        std::size_t size = 0;
        for (idx f = 0; f < m_->cell_count(); ++f)
        {
            if (!has(f)) continue;
            ++size;
            for (idx k = 0; k < 3; ++k)
                if (const idx g = across(3 * f + k); g >= 0 && !has(g))
                    touched[static_cast<std::size_t>(part[static_cast<std::size_t>(g)])] = 1;
        }
        std::size_t largest = sizes.size();
        for (std::size_t p = 0; p < sizes.size(); ++p)
            if (touched[p] && (largest == sizes.size() || sizes[p] > sizes[largest])) largest = p;
        bool any = false;
        for (std::size_t p = 0; p < sizes.size(); ++p) touched[p] = touched[p] && p != largest && sizes[p] < size;
        for (std::size_t f = 0; f < has_.size(); ++f)
            if (!has_[f] && touched[static_cast<std::size_t>(part[f])])
            {
                has_[f] = 1;
                any = true;
            }
        return any;
    }

    /// Smooths the rim: removes triangles with two sides on it, and adds those that have two from outside. Triangle
    /// `start` is kept.
    void smooth_rim(idx start)
    {
        for (const char of : {char(1), char(0)})
            for (idx f = 0; f < m_->cell_count(); ++f)
            {
                if (has(f) != (of == 1) || f == start) continue;
                int sides = 0;
                for (idx s = 3 * f; s < 3 * f + 3; ++s)
                {
                    const idx g = across(s);
                    if (of == 1 ? g < 0 || !has(g) : g >= 0 && has(g)) ++sides;
                }
                if (sides == 2) has_[static_cast<std::size_t>(f)] = of == 0;
            }
    }

    /// Adds all of the rest that does not reach the boundary of the surface.
    void fill_inside()
    {
        idx parts = 0;
        const auto part = label(0, [&](idx, std::size_t) { ++parts; });
        std::vector<char> open(static_cast<std::size_t>(parts), 0);
        for (std::size_t f = 0; f < has_.size(); ++f)
            for (idx k = 0; k < 3 && part[f] >= 0; ++k)
                if (across(3 * static_cast<idx>(f) + k) < 0) open[static_cast<std::size_t>(part[f])] = 1;
        for (std::size_t f = 0; f < has_.size(); ++f)
            if (part[f] >= 0 && !open[static_cast<std::size_t>(part[f])]) has_[f] = 1;
    }

    /// Vertices whose triangles of the set form more than one fan.
    std::vector<idx> pinched_vertices() const
    {
        std::vector<idx> result;
        for_each_pinch([&](idx v, const auto&) { result.push_back(v); });
        return result;
    }

    /// At each pinched vertex removes all fans but the largest, or that of triangle `start`. Returns whether there was
    /// any.
    bool trim_pinches(idx start)
    {
        bool any = false;
        for_each_pinch(
            [&](idx, const std::vector<std::vector<idx>>& fans)
            {
                any = true;
                std::size_t kept = 0;
                for (std::size_t i = 1; i < fans.size(); ++i)
                    if (fans[i].size() > fans[kept].size()) kept = i;
                for (std::size_t i = 0; i < fans.size(); ++i)
                    if (std::find(fans[i].begin(), fans[i].end(), start) != fans[i].end()) kept = i;
                for (std::size_t i = 0; i < fans.size(); ++i)
                    if (i != kept)
                        for (const idx f : fans[i]) has_[static_cast<std::size_t>(f)] = 0;
            });
        return any;
    }

    /// Adds what makes the set a disk whose rim no edge of the rest joins twice: all that it encloses, the triangles of
    /// pinched vertices, and those on both sides of an edge of the rest between two vertices of the rim. It may grow to
    /// the boundary of the surface.
    void widen()
    {
        const csr around = vertex_cells(*m_);
        for (bool changed = true; changed;)
        {
            fill_inside();
            changed = false;
            for (const idx v : pinched_vertices())
                for (const idx f : around.row(v)) changed = add(f) || changed;
            std::vector<char> on_rim(m_->points().size(), 0);
            for (idx s = 0; s < 3 * m_->cell_count(); ++s)
                if (has(s / 3) && (across(s) < 0 || !has(across(s))))
                    for (const idx v : side_vertices(*m_, s)) on_rim[static_cast<std::size_t>(v)] = 1;
            std::vector<idx> joined;
            for (idx s = 0; s < 3 * m_->cell_count(); ++s)
            {
                if (has(s / 3) || (across(s) >= 0 && has(across(s)))) continue;
                const auto [a, b] = side_vertices(*m_, s);
                if (on_rim[static_cast<std::size_t>(a)] && on_rim[static_cast<std::size_t>(b)]) joined.push_back(s / 3);
            }
            for (const idx f : joined) changed = add(f) || changed;
        }
    }

    /// Adds all that is reached from the triangles of these sides without crossing one of them. Returns false if that
    /// leads across one to its other side.
    bool flood(std::span<const idx> barrier)
    {
        std::vector<char> closed(sides_->twin.size(), 0);
        std::vector<idx> stack;
        for (const idx s : barrier)
        {
            closed[static_cast<std::size_t>(s)] = 1;
            if (!has(s / 3)) stack.push_back(s / 3);
            add(s / 3);
        }
        while (!stack.empty())
        {
            const idx f = stack.back();
            stack.pop_back();
            for (idx s = 3 * f; s < 3 * f + 3; ++s)
            {
                const idx g = across(s);
                if (g < 0 || closed[static_cast<std::size_t>(s)]) continue;
                if (closed[static_cast<std::size_t>(sides_->twin[static_cast<std::size_t>(s)])]) return false;
                if (has(g)) continue;
                add(g);
                stack.push_back(g);
            }
        }
        return true;
    }

private:
    /// The part of each triangle that is in the set (of = 1) or not (of = 0), -1 for the others; tells the first
    /// triangle and the size of each.
    template <class Tell>
    std::vector<idx> label(char of, const Tell& tell) const
    {
        std::vector<idx> part(has_.size(), -1), stack;
        idx parts = 0;
        for (idx start = 0; start < m_->cell_count(); ++start)
        {
            if (has_[static_cast<std::size_t>(start)] != of || part[static_cast<std::size_t>(start)] >= 0) continue;
            stack.assign(1, start);
            part[static_cast<std::size_t>(start)] = parts;
            std::size_t size = 0;
            while (!stack.empty())
            {
                const idx f = stack.back();
                stack.pop_back();
                ++size;
                for (idx k = 0; k < 3; ++k)
                {
                    const idx g = across(3 * f + k);
                    if (g < 0 || has_[static_cast<std::size_t>(g)] != of || part[static_cast<std::size_t>(g)] >= 0)
                        continue;
                    part[static_cast<std::size_t>(g)] = parts;
                    stack.push_back(g);
                }
            }
            tell(start, size);
            ++parts;
        }
        return part;
    }

    /// Calls pinch(vertex, its fans).
    template <class Pinch>
    void for_each_pinch(const Pinch& pinch) const
    {
        // A fan of boundary begins at each vertex that a rim side starts from.
        std::vector<idx> begins(m_->points().size(), 0);
        std::vector<char> used(m_->points().size(), 0);
        std::vector<idx> rim_sides, seen;
        for (idx f = 0; f < m_->cell_count(); ++f)
        {
            if (!has(f)) continue;
            for (idx s = 3 * f; s < 3 * f + 3; ++s)
            {
                const idx g = across(s);
                if (g >= 0 && has(g)) continue;
                const idx v = side_vertices(*m_, s)[0];
                if (begins[static_cast<std::size_t>(v)]++ > 0) used[static_cast<std::size_t>(v)] = 1;
                rim_sides.push_back(s);
            }
        }
        std::vector<std::pair<idx, std::vector<idx>>> fans; // vertex, triangles of one fan
        for (const idx s : rim_sides)
        {
            const idx v = side_vertices(*m_, s)[0];
            if (!used[static_cast<std::size_t>(v)]) continue;
            std::vector<idx> fan;
            for (idx side = s;;) // turns about v until the set ends
            {
                fan.push_back(side / 3);
                const idx back = side % 3 == 0 ? side + 2 : side - 1; // ends at v
                const idx twin = sides_->twin[static_cast<std::size_t>(back)];
                if (twin < 0 || !has(twin / 3)) break;
                side = twin;
            }
            fans.emplace_back(v, std::move(fan));
        }
        std::stable_sort(fans.begin(), fans.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        for (std::size_t i = 0; i < fans.size();)
        {
            std::vector<std::vector<idx>> of_vertex;
            const idx v = fans[i].first;
            for (; i < fans.size() && fans[i].first == v; ++i) of_vertex.push_back(std::move(fans[i].second));
            pinch(v, of_vertex);
        }
    }

    const mesh<triangle>* m_;
    const facet_table* sides_;
    std::vector<char> has_;
};

} // namespace taut::impl
