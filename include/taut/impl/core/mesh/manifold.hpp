// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <taut/impl/core/core/disjoint_sets.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/mesh/facets.hpp>
#include <taut/impl/core/mesh/ideal.hpp>

/// Tests that check() combines.
namespace taut::impl
{

/// Pairs of cells with the same corners. They share all their facets, so only facet neighbours are tested.
template <class Element>
std::vector<idx> duplicate_cells(const mesh<Element>& m, const facet_table& f)
{
    constexpr idx n = Element::corners;
    std::vector<std::pair<idx, idx>> pairs;
    const auto sorted = [&](idx c)
    {
        auto t = m.cells()[static_cast<std::size_t>(c)];
        std::sort(t.begin(), t.end());
        return t;
    };
    // Two cells that share two facets have all corners in common.
    for (idx c = 0; c < m.cell_count(); ++c)
    {
        const idx* twin = &f.twin[static_cast<std::size_t>(n * c)];
        for (int k = 1; k < n; ++k)
            if (twin[k] >= 0 && twin[0] >= 0 && twin[k] / n == twin[0] / n && c < twin[0] / n)
            {
                pairs.emplace_back(c, twin[0] / n);
                break;
            }
    }
    // More than two cells on a facet: equal ones are neighbours once sorted.
    for (const auto& crowd : f.crowds)
    {
        std::vector<std::pair<typename mesh<Element>::cell, idx>> cells;
        for (const idx side : crowd) cells.emplace_back(sorted(side / n), side / n);
        std::sort(cells.begin(), cells.end());
        for (std::size_t i = 1; i < cells.size(); ++i)
            if (cells[i].first == cells[i - 1].first) pairs.emplace_back(cells[i - 1].second, cells[i].second);
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    std::vector<idx> ids;
    for (const auto& [a, b] : pairs) ids.insert(ids.end(), {a, b});
    return ids;
}

/// Pairs of cells that are oriented differently and are not duplicates.
template <class Element>
std::vector<idx> clashing_cells(const mesh<Element>& m, const facet_table& f)
{
    constexpr idx n = Element::corners;
    const auto apex = [&](idx side)
    { return m.cells()[static_cast<std::size_t>(side / n)][static_cast<std::size_t>(side % n)]; };
    std::vector<idx> ids;
    for (const auto& [a, b] : f.clash)
        if (apex(a) != apex(b)) ids.insert(ids.end(), {a / n, b / n});
    return ids;
}

/// Returns whether the mesh is orientable: two-colours (kept, reversed) the graph of cells.
bool orientable(const facet_table& f, idx corners);

/// Vertices of all facets with three or more cells, `dimension` per facet.
template <class Element>
std::vector<idx> crowded_facets(const mesh<Element>& m, const facet_table& f)
{
    std::vector<idx> ids;
    for (const auto& crowd : f.crowds)
    {
        const auto v = side_vertices(m, crowd[0]);
        ids.insert(ids.end(), v.begin(), v.end());
    }
    return ids;
}

/// Corners of an oriented surface in the fan of one of them: those reached across edges at its vertex.
inline idx fan_size(const facet_table& f, idx corner)
{
    const auto turn = [](idx corner_or_side, idx by)
    { return corner_or_side % 3 < 3 - by ? corner_or_side + by : corner_or_side + by - 3; };
    const auto twin = [&](idx side) { return f.twin[static_cast<std::size_t>(side)]; };
    idx size = 1, at = corner, across = 0;
    while ((across = twin(turn(at, 1))) != facet_table::boundary)
    {
        at = turn(across, 1);
        if (at == corner) return size;
        ++size;
    }
    for (at = corner; (across = twin(turn(at, 2))) != facet_table::boundary; ++size) at = turn(across, 2);
    return size;
}

/// Vertices of an oriented surface whose triangles form more than one fan.
std::vector<idx> vertices_of_several_fans(const mesh<triangle>& m, const facet_table& f);

/// Vertices whose cells fall into several groups that share no facet at the vertex. Vertices of non-manifold facets are
/// left out.
template <class Element>
std::vector<idx> pinched_vertices(const mesh<Element>& m, const facet_table& f)
{
    if constexpr (Element::dimension == 2)
        if (f.oriented()) return vertices_of_several_fans(m, f);
    constexpr idx n = Element::corners;
    // Corners of one vertex in cells that share a facet belong together.
    disjoint_sets groups(m.cell_count() * n);
    for (idx side = 0; side < m.cell_count() * n; ++side)
    {
        const idx twin = f.twin[static_cast<std::size_t>(side)];
        if (twin < side) continue;
        const auto& a = m.cells()[static_cast<std::size_t>(side / n)];
        const auto& b = m.cells()[static_cast<std::size_t>(twin / n)];
        for (idx i = 0; i < n; ++i)
            for (idx j = 0; j < n && i != side % n; ++j)
                if (a[static_cast<std::size_t>(i)] == b[static_cast<std::size_t>(j)])
                    groups.join(side - side % n + i, twin - twin % n + j);
    }
    std::vector<idx> count(static_cast<std::size_t>(m.vertex_count()), 0);
    for (idx corner = 0; corner < m.cell_count() * n; ++corner)
        if (groups.find(corner) == corner)
            ++count[static_cast<std::size_t>(
                m.cells()[static_cast<std::size_t>(corner / n)][static_cast<std::size_t>(corner % n)])];
    for (const idx v : crowded_facets(m, f)) count[static_cast<std::size_t>(v)] = 0;
    std::vector<idx> ids;
    for (idx v = 0; v < m.vertex_count(); ++v)
        if (count[static_cast<std::size_t>(v)] > 1) ids.push_back(v);
    return ids;
}

struct component_list
{
    std::vector<idx> first;        ///< the smallest vertex of each component
    std::vector<idx> unreferenced; ///< vertices without a cell; they are no components
};

/// Components of cells that are connected through vertices.
template <class Element>
component_list components(const mesh<Element>& m)
{
    disjoint_sets sets(m.vertex_count());
    std::vector<char> used(static_cast<std::size_t>(m.vertex_count()), 0);
    for (const auto& t : m.cells())
        for (std::size_t k = 0; k < t.size(); ++k)
        {
            used[static_cast<std::size_t>(t[k])] = 1;
            if (k > 0) sets.join(t[0], t[k]);
        }
    component_list r;
    for (idx v = 0; v < m.vertex_count(); ++v)
        if (!used[static_cast<std::size_t>(v)])
            r.unreferenced.push_back(v);
        else if (sets.find(v) == v)
            r.first.push_back(v);
    return r;
}

} // namespace taut::impl
