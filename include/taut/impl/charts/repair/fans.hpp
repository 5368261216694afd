// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/impl/charts/repair/side_pairs.hpp>
#include <taut/impl/core/core/disjoint_sets.hpp>

/// Corners that are one vertex of the surface.
namespace taut::impl
{

/// The fan of each corner, by its first: those reached across paired sides.
inline std::vector<idx> fans(const placed_triangles& t, const side_pairs& pairs)
{
    const auto n = static_cast<idx>(pairs.twin.size());
    disjoint_sets sets(n);
    for (idx s = 0; s < n; ++s)
    {
        const idx other = pairs.twin[static_cast<std::size_t>(s)];
        if (other < s) continue;
        const auto [a, b] = placed_triangles::ends(s);
        auto [c, d] = placed_triangles::ends(other);
        if (t.place(a) != t.place(c)) std::swap(c, d);
        sets.join(a, c);
        sets.join(b, d);
    }
    std::vector<idx> fan(pairs.twin.size());
    for (idx a = 0; a < n; ++a) fan[static_cast<std::size_t>(a)] = sets.find(a);
    return fan;
}

/// Opens sides so that vertices name edges and triangles: sheets that touch along an edge and are connected around both
/// its ends have the same two vertices there, as if they were one edge; and a triangle stitched to another at its place
/// all around has the same three. Fans where that comes from sewing are taken apart again. Where it does not, all sides
/// of the edge are opened: fans fall apart at each, and a piece between two has these two at most, which run opposite
/// ways. As fans only become smaller, nothing of this kind comes anew.
/// f: facets of t.places. Returns whether anything was opened.
inline bool part_repeated(const placed_triangles& t, const facet_table& f, const std::vector<idx>& fan,
                          side_pairs& pairs)
{
    struct named_side
    {
        std::array<idx, 2> fans, edge;
        idx side;
    };
    const auto fan_at = [&](idx corner) { return fan[static_cast<std::size_t>(corner)]; };
    std::vector<char> unsew(fan.size(), 0);
    std::vector<named_side> sides;
    bool any = false;
    const auto mark = [&](idx corner)
    {
        unsew[static_cast<std::size_t>(fan_at(corner))] = 1;
        any = true;
    };
    for (const auto& crowd : f.crowds)
    {
        sides.clear();
        for (const idx s : crowd)
        {
            const auto [a, b] = placed_triangles::ends(s);
            sides.push_back({{std::min(fan_at(a), fan_at(b)), std::max(fan_at(a), fan_at(b))}, t.edge(s), s});
        }
        std::sort(sides.begin(), sides.end(),
                  [](const named_side& a, const named_side& b)
                  { return std::tie(a.fans, a.edge, a.side) < std::tie(b.fans, b.edge, b.side); });
        for (std::size_t k = 0, last = 0; k < sides.size(); k = last)
        {
            while (last < sides.size() && sides[last].fans == sides[k].fans) ++last;
            if (last - k <= 2) continue;
            if (sides[k].edge != sides[last - 1].edge)
                for (const idx a : placed_triangles::ends(sides[k].side)) mark(a);
            for (std::size_t i = k, same = k; i < last; i = same)
            {
                while (same < last && sides[same].edge == sides[i].edge) ++same;
                any = any || same - i > 2;
                for (std::size_t j = i; same - i > 2 && j < same; ++j) pairs.part(sides[j].side);
            }
        }
    }
    const auto twins = duplicate_cells(t.places, f);
    for (std::size_t i = 0; i < twins.size(); i += 2)
    {
        std::array<idx, 3> a{}, b{};
        for (idx k = 0; k < 3; ++k)
        {
            a[static_cast<std::size_t>(k)] = fan_at(3 * twins[i] + k);
            b[static_cast<std::size_t>(k)] = fan_at(3 * twins[i + 1] + k);
        }
        std::sort(a.begin(), a.end());
        std::sort(b.begin(), b.end());
        for (idx k = 0; k < 3 && a == b; ++k) mark(3 * twins[i] + k);
    }
    for (idx s = 0; any && s < static_cast<idx>(fan.size()); ++s)
        if (const idx other = pairs.twin[static_cast<std::size_t>(s)]; other >= 0 && t.edge(s) != t.edge(other))
            for (const idx a : placed_triangles::ends(s))
                if (unsew[static_cast<std::size_t>(fan_at(a))] != 0) pairs.part(s);
    return any;
}

} // namespace taut::impl
