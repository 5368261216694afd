// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <taut/impl/core/core/disjoint_sets.hpp>
#include <taut/impl/core/mesh/facets.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// Connected part of a mesh with an entirely pinned outline. The image of the outline is known, and so is the sum of
/// the signed measures of the mapped cells.
struct pinned_patch
{
    std::vector<idx> outline; ///< sides, ascending: facets of the cut mesh with one cell
    idx cells = 0;
    idx interior = 0;     ///< triangles: closed fans, which are the vertices inside
    bool boundary = true; ///< the outline is made of the boundary of the mesh alone
};

/// Cuts a mesh along the facets whose vertices are all pinned, and where neighbours disagree about orientation.
template <class Element>
facet_table cut_at_pins(const untangle_problem<Element>& p, facet_table f)
{
    const auto cut = [&f](std::size_t side) { f.twin[side] = facet_table::boundary; };
    for (std::size_t s = 0; s < f.twin.size(); ++s)
    {
        const auto v = side_vertices(p.rest, static_cast<idx>(s));
        const bool pinned =
            std::all_of(v.begin(), v.end(), [&](idx i) { return p.held.all(static_cast<std::size_t>(i)); });
        if (pinned || f.twin[s] < 0) cut(s);
    }
    for (const auto& sides : f.clash)
        for (const idx s : sides) cut(static_cast<std::size_t>(s));
    return f;
}

/// Calls interior(cell) for each closed fan of triangles of the cut mesh, with one of its triangles.
template <class Interior>
void for_each_closed_fan(const mesh<triangle>& m, const facet_table& cut, const Interior& interior)
{
    std::vector<char> seen(cut.twin.size(), 0); // by corner
    for (std::size_t start = 0; start < cut.twin.size(); ++start)
    {
        const idx v = m.cells()[start / 3][start % 3];
        std::size_t corner = start;
        while (!seen[corner])
        {
            seen[corner] = 1;
            // Over the side that follows the corner, into the next triangle of the fan.
            const idx twin = cut.twin[corner % 3 == 2 ? corner - 2 : corner + 1];
            if (twin < 0) break;
            const auto cell = static_cast<std::size_t>(twin / 3);
            const auto& t = m.cells()[cell];
            corner = 3 * cell + static_cast<std::size_t>(std::find(t.begin(), t.end(), v) - t.begin());
            if (corner == start) interior(static_cast<idx>(cell));
        }
    }
}

/// The patches with a pinned outline and more than one cell in the cut mesh, in the order of their first cells. Cells
/// whose vertices are all pinned are left out: their determinants decide.
template <class Element>
std::vector<pinned_patch> pinned_patches(const untangle_problem<Element>& p, const facet_table& f,
                                         const facet_table& cut)
{
    constexpr idx corners = Element::corners;
    const auto at = [](idx i) { return static_cast<std::size_t>(i); };
    const idx n = p.rest.cell_count();
    disjoint_sets sets(n);
    for (std::size_t s = 0; s < cut.twin.size(); ++s)
        if (cut.twin[s] >= 0) sets.join(static_cast<idx>(s) / corners, cut.twin[s] / corners);

    std::vector<pinned_patch> by_cell(1); // number 0 takes what is not complete
    std::vector<idx> number(at(n), -1);   // of the patch, by the cell that stands for it
    for (std::size_t s = 0; s < cut.twin.size(); ++s)
    {
        if (cut.twin[s] >= 0) continue;
        idx& patch = number[at(sets.find(static_cast<idx>(s) / corners))];
        const auto v = side_vertices(p.rest, static_cast<idx>(s));
        const bool pinned = std::all_of(v.begin(), v.end(), [&](idx i) { return p.held.all(at(i)); });
        if (!pinned)
        {
            if (patch > 0) by_cell[at(patch)] = {};
            patch = 0;
        }
        if (patch == 0) continue;
        if (patch < 0)
        {
            patch = static_cast<idx>(by_cell.size());
            by_cell.emplace_back();
        }
        auto& found = by_cell[at(patch)];
        found.outline.push_back(static_cast<idx>(s));
        found.boundary = found.boundary && f.twin[s] < 0;
    }
    const auto patch_of = [&](idx cell) { return std::max<idx>(number[at(sets.find(cell))], 0); };
    for (idx c = 0; c < n; ++c) ++by_cell[at(patch_of(c))].cells;
    if constexpr (Element::dimension == 2)
        for_each_closed_fan(p.rest, cut, [&](idx cell) { ++by_cell[at(patch_of(cell))].interior; });

    by_cell.erase(by_cell.begin());
    std::erase_if(by_cell, [](const pinned_patch& patch) { return patch.outline.empty() || patch.cells < 2; });
    return by_cell;
}

} // namespace taut::impl
