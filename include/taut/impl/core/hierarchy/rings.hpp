// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/impl/core/core/parallel.hpp>

namespace taut::impl
{

/// An oriented surface as the neighbours of each vertex, counter-clockwise: triangle (v, ring[i], ring[i + 1]) for each
/// pair of consecutive ones, and for an inner vertex (v, last, first) too. A boundary vertex (`open`) starts and ends
/// with its neighbours along the boundary. No edges or cells are stored: collapses then concern vertices only.
struct ring_table
{
    struct range
    {
        idx first = 0;
        idx size = 0; ///< 0: a vertex without triangles, or one that is gone
    };
    std::vector<range> ranges;
    std::vector<idx> items;

    std::span<const idx> operator[](idx v) const
    {
        const range r = ranges[static_cast<std::size_t>(v)];
        return {items.data() + r.first, static_cast<std::size_t>(r.size)};
    }
};

/// Position of v in a ring, or -1.
inline int find(std::span<const idx> ring, idx v)
{
    for (std::size_t i = 0; i < ring.size(); ++i)
        if (ring[i] == v) return static_cast<int>(i);
    return -1;
}

/// True if positions i and j of a ring of n are consecutive.
inline bool consecutive(int i, int j, int n, bool open)
{
    const int apart = i < j ? j - i : i - j;
    return apart == 1 || (!open && apart == n - 1);
}

/// Finds the two other corners of a triangle at a vertex, counter-clockwise.
using spoke_pair = std::pair<idx, idx>;

/// Sorts the triangles around a vertex. Returns false if they do not form one fan.
bool order_fan(std::span<spoke_pair> fan, bool& open);

/// Computes the rings of a surface of `count` vertices, and marks the boundary vertices.
/// Throws mesh_error (non_manifold_vertex) if the triangles of a vertex do not form one oriented fan.
ring_table make_rings(std::span<const std::array<idx, 3>> cells, std::size_t count, std::vector<char>& open,
                      unsigned threads);

/// The triangles of a surface, each at its smallest vertex, which is its first corner.
inline std::vector<std::array<idx, 3>> ring_cells(const ring_table& rings, std::span<const char> open)
{
    std::vector<std::array<idx, 3>> cells;
    for (std::size_t v = 0; v < rings.ranges.size(); ++v)
    {
        const auto ring = rings[static_cast<idx>(v)];
        const auto here = static_cast<idx>(v);
        for (std::size_t i = 0; i + (open[v] ? 1 : 0) < ring.size(); ++i)
        {
            const idx a = ring[i], b = ring[i + 1 < ring.size() ? i + 1 : 0];
            if (here < a && here < b) cells.push_back({here, a, b});
        }
    }
    return cells;
}

} // namespace taut::impl
