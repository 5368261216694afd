// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <taut/elements.hpp>
#include <taut/impl/core/mesh/incidence.hpp>
#include <taut/types.hpp>

namespace taut::view
{

/// The vertex near from + by that a walk along edges finds: each step goes to the neighbour that is nearest to there,
/// as long as it is nearer than the last one, so that the walk stays on its sheet of the surface. Where no neighbour is
/// nearer than from itself, as edges are long: the neighbour that lies most in the direction of by, less than 60
/// degrees aside, or from. from: a vertex of the mesh; by: finite.
inline idx walk(const mesh<triangle>& m, idx from, const vec3& by)
{
    const auto at = [&](idx v) -> const vec3& { return m.points()[static_cast<std::size_t>(v)]; };
    const auto around = taut::impl::vertex_neighbours(m);
    const vec3 goal = at(from) + by;
    for (idx v = from;;)
    {
        idx next = v;
        for (const idx w : around.row(v))
            if (distance(at(w), goal) < distance(at(next), goal)) next = w;
        if (next == v && v != from) return v;
        if (next == v) break;
        v = next;
    }
    idx best = from;
    double most = 0.5;
    for (const idx w : around.row(from))
    {
        const vec3 way = at(w) - at(from);
        const double cosine = dot(way, by) / (length(way) * length(by));
        if (cosine > most)
        {
            most = cosine;
            best = w;
        }
    }
    return best;
}

} // namespace taut::view
