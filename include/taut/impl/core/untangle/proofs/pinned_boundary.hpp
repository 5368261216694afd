// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <taut/impl/core/core/disjoint_sets.hpp>
#include <taut/impl/core/mesh/facets.hpp>
#include <taut/impl/core/untangle/proofs/pinned_outline.hpp>
#include <taut/mesh.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// Components of an oriented surface with entirely pinned boundaries: the number of times that a map of positive
/// triangles covers a point is known there, as the winding number of the boundary.
struct pinned_boundaries
{
    struct component
    {
        std::vector<std::array<idx, 2>> edges; ///< of all its loops
        std::size_t loops = 0;
        bool pinned = true;
        bool simple = true; ///< one loop that does not meet itself: no point is covered twice
    };
    std::vector<component> components;
    std::vector<idx> of_vertex;    ///< number of the component; -1: not pinned, or no boundary
    std::vector<char> on_boundary; ///< one per vertex

    /// True if both edges lie in one component where no point is covered twice.
    bool exclusive(const std::array<idx, 2>& e, const std::array<idx, 2>& f) const
    {
        const idx c = of_vertex[static_cast<std::size_t>(e[0])];
        return c >= 0 && c == of_vertex[static_cast<std::size_t>(f[0])] &&
               components[static_cast<std::size_t>(c)].simple;
    }
};

pinned_boundaries find_pinned_boundaries(const untangle_problem<triangle>& p, const facet_table& f);

/// Edges of triangles between vertices that are pinned, each once.
template <class Pinned>
std::vector<std::array<idx, 2>> pinned_edges(const mesh<triangle>& m, const Pinned& pinned)
{
    std::vector<std::array<idx, 2>> edges;
    for (idx side = 0; side < 3 * m.cell_count(); ++side)
        if (const auto [a, b] = side_vertices(m, side); pinned(a) && pinned(b))
            edges.push_back({std::min(a, b), std::max(a, b)});
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

/// Finds pinned inner vertices that lie outside of the pinned boundary, or on a simple one. The image of an inner
/// vertex is covered, and so are all points around it.
inline std::vector<idx> vertices_outside(const untangle_problem<triangle>& p, const pinned_boundaries& b)
{
    std::vector<idx> outside;
    std::size_t budget = 50'000'000; // edges looked at
    for (std::size_t v = 0; v < p.initial.size(); ++v)
    {
        if (b.of_vertex[v] < 0 || b.on_boundary[v] || !p.held.all(v)) continue;
        const auto& c = b.components[static_cast<std::size_t>(b.of_vertex[v])];
        if (budget < c.edges.size()) break;
        budget -= c.edges.size();
        const auto winding = winding_number(c.edges, p.initial, p.initial[v]);
        if (winding ? *winding <= 0 : c.simple) outside.push_back(static_cast<idx>(v));
    }
    return outside;
}

} // namespace taut::impl
