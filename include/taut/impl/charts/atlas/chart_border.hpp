// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/charts.hpp>

namespace taut::impl
{

/// Calls side(from, to) for the sides that bound chart k, by the first of their vertices.
template <class Side>
void for_each_border_side(const chart_mesh& charts, idx k, Side&& side)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    const idx first = charts.first_vertex[u(k)];
    const std::span cells(charts.surface.cells().data() + charts.first_cell[u(k)],
                          charts.surface.cells().data() + charts.first_cell[u(k) + 1]);
    static thread_local std::vector<idx> start, ends; // ends of the sides that start at each vertex
    const idx count = charts.first_vertex[u(k) + 1] - first;
    start.assign(u(count) + 2, 0);
    ends.resize(3 * cells.size());
    for (const auto& t : cells)
        for (const idx v : t) ++start[u(v - first) + 2];
    for (std::size_t v = 2; v < start.size(); ++v) start[v] += start[v - 1];
    for (const auto& t : cells)
        for (std::size_t j = 0; j < 3; ++j) ends[u(start[u(t[j] - first) + 1]++)] = t[(j + 1) % 3] - first;
    const auto ends_of = [&](idx v)
    { return std::span(ends).subspan(u(start[u(v)]), u(start[u(v) + 1] - start[u(v)])); };
    constexpr std::size_t few = 12; // that are searched one by one
    for (idx v = 0; v < count; ++v)
        if (ends_of(v).size() > few) std::sort(ends_of(v).begin(), ends_of(v).end());
    const auto leads = [&](idx v, idx w)
    {
        const auto ends_there = ends_of(v);
        return ends_there.size() > few ? std::binary_search(ends_there.begin(), ends_there.end(), w)
                                       : std::find(ends_there.begin(), ends_there.end(), w) != ends_there.end();
    };
    for (idx v = 0; v < count; ++v)
        for (const idx w : ends_of(v))
            if (!leads(w, v)) side(first + v, first + w);
}

/// Boundary loops of chart k, as boundary_loops() of all charts. A vertex has one fan of triangles.
inline std::vector<std::vector<idx>> border_loops(const chart_mesh& charts, idx k)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    const idx first = charts.first_vertex[u(k)];
    std::vector<idx> next(u(charts.first_vertex[u(k) + 1] - first), -1);
    for_each_border_side(charts, k, [&](idx from, idx to) { next[u(from - first)] = to - first; });
    std::vector<std::vector<idx>> loops;
    for (idx v = 0; v < static_cast<idx>(next.size()); ++v)
    {
        if (next[u(v)] < 0) continue;
        auto& loop = loops.emplace_back();
        for (idx w = v, after; (after = next[u(w)]) >= 0; w = after)
        {
            loop.push_back(first + w);
            next[u(w)] = -1;
        }
    }
    return loops;
}

} // namespace taut::impl
