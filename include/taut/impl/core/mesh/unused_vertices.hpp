// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <taut/types.hpp>

namespace taut::impl
{

/// Finds unreferenced vertices, of `count`, ascending. Numbers out of range are ignored.
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

/// Moves unreferenced vertices to the position of a referenced one, so that they do not affect bounding boxes.
template <class Point, class Cell>
void set_aside(std::span<const idx> unused, const std::vector<Cell>& cells, std::vector<Point>& points)
{
    if (unused.empty() || points.empty()) return;
    const Point place = points[static_cast<std::size_t>(cells[0][0])];
    for (const idx v : unused) points[static_cast<std::size_t>(v)] = place;
}

} // namespace taut::impl
