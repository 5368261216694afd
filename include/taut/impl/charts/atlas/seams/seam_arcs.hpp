// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/core/core/csr.hpp>
#include <taut/impl/core/mesh/facets.hpp>
#include <taut/impl/core/mesh/incidence.hpp>

namespace taut::impl
{

/// Inner edges around vertices, as the sides that start there. A side and its twin start at its two ends.
inline idx first_vertex(const mesh<triangle>& m, idx side)
{
    return m.cells()[static_cast<std::size_t>(side / 3)][static_cast<std::size_t>((side + 1) % 3)];
}

/// The sides that start at each vertex, ascending by triangle.
inline csr starting_sides(const mesh<triangle>& m)
{
    csr sides = vertex_corners(m);
    for (idx& i : sides.items) i = i / 3 * 3 + (i % 3 + 2) % 3; // from corner k runs the side opposite corner k + 2
    return sides;
}

/// Seams of a surface as arcs between nodes, vertices at which they end, branch, or meet the boundary. An arc is a
/// chain of sides, each beginning where the one before ends; arcs that are closed and have no node are left out.
/// sides: starting_sides(m); seam: one flag per side
inline csr seam_arcs(const mesh<triangle>& m, const facet_table& f, const csr& sides, std::span<const char> seam)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    std::vector<idx> degree(m.points().size(), 0);
    for (std::size_t s = 0; s < seam.size(); ++s)
        if (f.twin[s] < 0)
            degree[u(first_vertex(m, static_cast<idx>(s)))] += 3; // always a node
        else if (seam[s])
            ++degree[u(first_vertex(m, static_cast<idx>(s)))];
    std::vector<char> done(seam.size(), 0);
    csr arcs{{0}, {}};
    for (std::size_t start = 0; start < seam.size(); ++start)
    {
        auto s = static_cast<idx>(start);
        if (f.twin[start] < 0 || !seam[start] || done[start] || degree[u(first_vertex(m, s))] == 2) continue;
        for (;;)
        {
            const idx t = f.twin[u(s)], end = first_vertex(m, t);
            done[u(s)] = done[u(t)] = 1;
            arcs.items.push_back(s);
            if (degree[u(end)] != 2) break;
            for (const idx next : sides.row(end))
                if (next != t && f.twin[u(next)] >= 0 && seam[u(next)])
                {
                    s = next;
                    break;
                }
        }
        arcs.offsets.push_back(static_cast<idx>(arcs.items.size()));
    }
    return arcs;
}

} // namespace taut::impl
