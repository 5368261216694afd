// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/parallel.hpp>
#include <taut/impl/core/types.hpp>
#include <taut/impl/exact/predicates.hpp>
#include <taut/impl/exact/simplex_role.hpp>

namespace taut::impl
{

/// The cells around one vertex, as the edges of its link.
class vertex_link
{
public:
    void add(idx from, idx to) { edges_.push_back({from, to}); }

    /// Closed loops that the edges form; 0 if one of them does not close: the vertex lies on a boundary, or the surface
    /// is no manifold there.
    std::size_t loops();

private:
    /// The one edge that begins where e ends, or their number if there is none or more than one.
    std::size_t after(std::size_t e) const
    {
        const idx v = edges_[e].second;
        const auto next =
            std::partition_point(edges_.begin(), edges_.end(), [v](const auto& edge) { return edge.first < v; });
        const bool single =
            next != edges_.end() && next->first == v && (next + 1 == edges_.end() || next[1].first != v);
        return single ? static_cast<std::size_t>(next - edges_.begin()) : edges_.size();
    }

    std::vector<std::pair<idx, idx>> edges_;
};

} // namespace taut::impl

namespace taut
{

/// Finds branch points: inner vertices of a surface around which a map winds more than once: the triangles there agree
/// in orientation, but overlap. A map of a disk onto a simple outline without flipped triangles has none.
///
/// Exact: around a vertex v of positive triangles (v, a, b) the link runs counter-clockwise, so it winds once for each
/// edge (a, b) that crosses the horizontal line through v upwards, and whether it does is a comparison of coordinates.
/// Vertices on a boundary, or whose triangles differ in orientation, are not looked at.
///
/// cells: #F by 3 vertex indices, in range; x: one image point per vertex. owners: where triangles are the corners of
/// quads, the cell of each; a quad is an edge of the links of its own corners alone. Ascending.
std::vector<idx> branch_points(std::span<const std::array<idx, 3>> cells, std::span<const vec2> x,
                               std::span<const idx> owners = {});

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/exact/branch_points.ipp>
#endif
