// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <taut/impl/core/hierarchy/collapse.hpp>

namespace taut::impl
{

/// Collapses of one round. No two removed vertices are neighbours, so their stars have no triangle in common.
struct collapse_round
{
    struct collapse
    {
        idx vertex;
        int target; ///< position in its ring, or -1: it stays
    };
    std::vector<collapse> collapses;
    std::vector<idx> first_corner; ///< where the corners of each one's flat star begin, and the end
    std::vector<vec2> corners;     ///< flat stars, the vertex at the origin
    std::vector<idx> of;           ///< collapse of a vertex, or -1

    const collapse* removing(idx v) const
    {
        const idx c = of[static_cast<std::size_t>(v)];
        return c < 0 ? nullptr : &collapses[static_cast<std::size_t>(c)];
    }
};

/// True if the collapse makes the edge (a, b). a and b are neighbours of its vertex or not.
inline bool makes_edge(const thinning_surface& m, const collapse_round::collapse& c, idx a, idx b)
{
    const auto ring = m.rings[c.vertex];
    const idx u = ring[static_cast<std::size_t>(c.target)];
    if (u != a && u != b) return false;
    const int other = find(ring, u == a ? b : a);
    return other >= 0 && !consecutive(other, c.target, static_cast<int>(ring.size()),
                                      m.open[static_cast<std::size_t>(c.vertex)] != 0);
}

/// True if another collapse of the round makes an edge of this one too and has priority. Both removed vertices are then
/// neighbours of both ends.
inline bool loses(const thinning_surface& m, const collapse_round& round, const collapse_round::collapse& mine,
                  std::span<const std::uint32_t> key)
{
    const idx v = mine.vertex;
    const auto ring = m.rings[v];
    const int n = static_cast<int>(ring.size());
    const bool open = m.open[static_cast<std::size_t>(v)] != 0;
    const idx u = ring[static_cast<std::size_t>(mine.target)];
    for (const idx w : m.rings[u])
    {
        const auto* const rival = w == v ? nullptr : round.removing(w);
        if (rival == nullptr || rival->target < 0) continue;
        const std::uint32_t theirs = key[static_cast<std::size_t>(w)], ours = key[static_cast<std::size_t>(v)];
        if (theirs > ours || (theirs == ours && w > v)) continue;
        for (int i = 0; i < n; ++i)
            if (i != mine.target && !consecutive(i, mine.target, n, open) &&
                makes_edge(m, *rival, u, ring[static_cast<std::size_t>(i)]))
                return true;
    }
    return false;
}

/// Writes the ring of x after the round to `out`, which has room for largest_star neighbours for each that x has, and
/// returns its end.
inline idx* splice(const thinning_surface& m, const collapse_round& round, idx x, idx* out)
{
    for (const idx w : m.rings[x])
    {
        const auto* const c = round.removing(w);
        if (c == nullptr)
        {
            *out++ = w;
            continue;
        }
        const auto ring = m.rings[w];
        const int n = static_cast<int>(ring.size());
        const bool open = m.open[static_cast<std::size_t>(w)] != 0;
        const int here = find(ring, x);
        if (here != c->target)
        {
            // Either both triangles with the target close, or the spoke to w becomes one to the target.
            if (!consecutive(here, c->target, n, open)) *out++ = ring[static_cast<std::size_t>(c->target)];
            continue;
        }
        // x is the target: spokes to all but its neighbours in the ring.
        const int first = open && here > 0 ? 0 : here + 2;
        const int count = open ? n - 2 : n - 3;
        for (int i = first; i < first + count; ++i) *out++ = ring[static_cast<std::size_t>(i < n ? i : i - n)];
    }
    return out;
}

} // namespace taut::impl
