// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
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
    std::size_t loops()
    {
        std::sort(edges_.begin(), edges_.end());
        std::vector<char> seen(edges_.size(), 0);
        std::size_t count = 0;
        for (std::size_t first = 0; first < edges_.size(); ++first)
        {
            if (seen[first]) continue;
            ++count;
            std::size_t e = first;
            do {
                if (seen[e]) return 0;
                seen[e] = 1;
                e = after(e);
                if (e == edges_.size()) return 0;
            } while (e != first);
        }
        return count;
    }

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
inline std::vector<idx> branch_points(std::span<const std::array<idx, 3>> cells, std::span<const vec2> x,
                                      std::span<const idx> owners = {})
{
    const auto roles = impl::simplex_roles<2>(owners);
    const auto corners_of = [&](std::size_t t)
    { return roles.empty() || roles[t] == impl::simplex_role::cell ? std::size_t{3} : std::size_t{1}; };
    const auto at = [&](idx v) -> const vec2& { return x[static_cast<std::size_t>(v)]; };
    const auto rises = [&](idx v, idx a, idx b) { return at(a).y < at(v).y && at(b).y >= at(v).y; };
    std::vector<std::uint16_t> turns(x.size(), 0); // two and more are told apart from fewer, no further
    std::atomic<bool> suspicious{false};
    impl::parallel_for(cells.size(),
                       [&](std::size_t begin, std::size_t end)
                       {
                           for (std::size_t c = begin; c < end; ++c)
                               for (std::size_t k = 0; k < corners_of(c); ++k)
                               {
                                   const auto& t = cells[c];
                                   if (!rises(t[k], t[(k + 1) % 3], t[(k + 2) % 3])) continue;
                                   const std::atomic_ref n(turns[static_cast<std::size_t>(t[k])]);
                                   if (n.load(std::memory_order_relaxed) < 2 && n.fetch_add(1) == 1) suspicious = true;
                               }
                       });
    if (!suspicious) return {};

    struct neighbourhood
    {
        idx vertex;
        std::size_t turns = 0;
        bool positive = false, negative = false;
        impl::vertex_link link;

        bool oriented() const { return positive != negative; }
    };
    std::vector<neighbourhood> around;
    std::vector<idx> place(x.size(), -1);
    for (std::size_t v = 0; v < x.size(); ++v)
        if (turns[v] >= 2)
        {
            place[v] = static_cast<idx>(around.size());
            around.push_back({.vertex = static_cast<idx>(v), .link = {}});
        }
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (std::size_t k = 0; k < corners_of(c); ++k)
        {
            const auto& t = cells[c];
            const idx i = place[static_cast<std::size_t>(t[k])], a = t[(k + 1) % 3], b = t[(k + 2) % 3];
            if (i < 0) continue;
            auto& n = around[static_cast<std::size_t>(i)];
            n.link.add(a, b);
            n.turns += rises(t[k], a, b);
            const int sign = impl::orient(at(t[k]), at(a), at(b)).sign;
            n.positive = n.positive || sign >= 0;
            n.negative = n.negative || sign <= 0;
        }
    std::vector<idx> found;
    for (auto& n : around)
        if (const std::size_t loops = n.oriented() ? n.link.loops() : 0; loops > 0 && n.turns > loops)
            found.push_back(n.vertex);
    return found;
}

} // namespace taut
