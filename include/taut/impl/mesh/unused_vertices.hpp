// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/core/types.hpp>

namespace taut::impl
{

/// The vertices, of `count`, that no cell names, ascending. Numbers that are no vertices are passed over.
template <class Cell>
std::vector<idx> unused_vertices(std::size_t count, const std::vector<Cell>& cells)
{
    std::vector<char> used(count, 0);
    for (const Cell& cell : cells)
        for (const idx v : cell)
            if (v >= 0 && static_cast<std::size_t>(v) < count) used[static_cast<std::size_t>(v)] = 1;
    std::vector<idx> unused;
    for (std::size_t v = 0; v < count; ++v)
        if (!used[v]) unused.push_back(static_cast<idx>(v));
    return unused;
}

/// Brings unused vertices to the place of one that a cell names, where they widen no box and lie in nobody's way.
template <class Point, class Cell>
void set_aside(std::span<const idx> unused, const std::vector<Cell>& cells, std::vector<Point>& points)
{
    if (unused.empty() || points.empty()) return;
    const Point place = points[static_cast<std::size_t>(cells[0][0])];
    for (const idx v : unused) points[static_cast<std::size_t>(v)] = place;
}

} // namespace taut::impl
