// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <taut/certify.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/exact/branch_points.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/impl/core/exact/simplex_role.hpp>

namespace taut::impl
{

/// An edge of a volume, and whether a tetrahedron around it crosses the half-plane that leaves the edge along a
/// coordinate axis. Where all of them are positive, as many do as there are turns around it.
class edge_turns
{
public:
    using edge = std::array<idx, 2>;

    edge_turns(std::span<const std::array<idx, 4>> cells, std::span<const vec3> x, std::span<const idx> owners)
        : cells_(cells), x_(x), roles_(simplex_roles<3>(owners))
    {
    }

    /// Calls visit(edge, c, d) for the edges of a cell; (a, b, c, d) is an even permutation of corners. Of tetrahedra
    /// alone, a < b. A quad at an edge lies elsewhere at the other end, so where there are any, an edge is looked at
    /// from both ends: a is the corner that the simplex is at, and c and d are what follows it in the two sides.
    template <class Visit>
    void for_edges(std::size_t cell, const Visit& visit) const
    {
        const auto& t = cells_[cell];
        const auto role = roles_.empty() ? simplex_role::cell : roles_[cell];
        if (role == simplex_role::edge) return;
        if (role != simplex_role::cell)
        {
            for (std::size_t k = 1; k < 4; ++k) visit(edge{t[0], t[k]}, t[k % 3 + 1], t[(k + 1) % 3 + 1]);
            if (role == simplex_role::pyramid_corner) visit(edge{t[3], t[0]}, t[2], t[1]); // which has none at its apex
            return;
        }
        constexpr int edges[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                     {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};
        for (const auto& e : edges)
        {
            std::array<idx, 4> v;
            for (std::size_t k = 0; k < 4; ++k) v[k] = t[static_cast<std::size_t>(e[k])];
            if (!roles_.empty())
                visit(edge{v[1], v[0]}, v[3], v[2]);
            else if (v[0] > v[1])
                std::swap(v[0], v[1]), std::swap(v[2], v[3]);
            visit(edge{v[0], v[1]}, v[2], v[3]);
        }
    }

    bool crosses(const edge& e, idx c, idx d) const
    {
        const vec3 &a = at(e[0]), &b = at(e[1]), along = b - a;
        // Along the axis that the edge has least of: seen in its direction the edge is long.
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (std::abs(along[k]) < std::abs(along[axis])) axis = k;
        const auto seen = [axis](const vec3& p) { return vec2(p[(axis + 1) % 3], p[(axis + 2) % 3]); };
        return orient_sign(seen(a), seen(b), seen(at(c))) < 0 && orient_sign(seen(a), seen(b), seen(at(d))) >= 0;
    }

    int sign(std::size_t cell) const
    {
        const auto& t = cells_[cell];
        return orient(at(t[0]), at(t[1]), at(t[2]), at(t[3])).sign;
    }

private:
    static int orient_sign(const vec2& a, const vec2& b, const vec2& c) { return orient(a, b, c).sign; }
    const vec3& at(idx v) const { return x_[static_cast<std::size_t>(v)]; }

    std::span<const std::array<idx, 4>> cells_;
    std::span<const vec3> x_;
    std::vector<simplex_role> roles_;
};

/// Edges inside a volume that the tetrahedra of a map go around more than once: the dihedral angles there sum to two
/// turns or more, and the tetrahedra overlap although all of them are positive. Where there is none and no tetrahedron
/// is flipped, the map is locally injective: around an inner vertex it then covers the sphere once, which is simply
/// connected.
///
/// Exact, by signs of determinants. Around an edge of positive tetrahedra their other corners turn one way by less
/// than half a turn at a time, so they pass a half-plane at the edge once a turn. Edges on the boundary, or whose
/// tetrahedra differ in orientation, are not looked at.
///
/// cells: #T by 4 vertex indices, in range; x: one image point a vertex. owners: where tetrahedra are the corners of
/// other cells, the cell of each; a cell is then an edge of the links of its own edges alone. Smaller vertex first,
/// ascending.
inline std::vector<std::array<idx, 2>> branch_edges(std::span<const std::array<idx, 4>> cells, std::span<const vec3> x,
                                                    std::span<const idx> owners = {})
{
    const impl::edge_turns turns(cells, x, owners);
    using edge = impl::edge_turns::edge;
    constexpr std::size_t block = 8192;
    std::vector<std::vector<edge>> parts((cells.size() + block - 1) / block);
    parallel_for(
        parts.size(),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t p = begin; p < end; ++p)
                for (std::size_t t = p * block; t < std::min(cells.size(), (p + 1) * block); ++t)
                    turns.for_edges(t,
                                    [&](const edge& e, idx c, idx d)
                                    {
                                        if (turns.crosses(e, c, d)) parts[p].push_back(e);
                                    });
        },
        0, 2);
    std::vector<edge> crossed;
    for (const auto& part : parts) crossed.insert(crossed.end(), part.begin(), part.end());
    std::sort(crossed.begin(), crossed.end());

    struct neighbourhood
    {
        std::size_t turns = 0;
        bool positive = false, negative = false;
        impl::vertex_link link;
    };
    std::map<edge, neighbourhood> suspicious;
    for (auto at = crossed.begin(); (at = std::adjacent_find(at, crossed.end())) != crossed.end(); ++at)
        suspicious[*at];
    if (suspicious.empty()) return {};
    for (std::size_t t = 0; t < cells.size(); ++t)
        turns.for_edges(t,
                        [&](const edge& e, idx c, idx d)
                        {
                            const auto found = suspicious.find(e);
                            if (found == suspicious.end()) return;
                            auto& n = found->second;
                            n.link.add(c, d);
                            n.turns += turns.crosses(e, c, d);
                            const int sign = turns.sign(t);
                            n.positive = n.positive || sign >= 0;
                            n.negative = n.negative || sign <= 0;
                        });
    std::vector<edge> found;
    for (auto& [e, n] : suspicious)
        if (const std::size_t loops = n.positive != n.negative ? n.link.loops() : 0; loops > 0 && n.turns > loops)
            found.push_back({std::min(e[0], e[1]), std::max(e[0], e[1])});
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end()); // seen from both ends
    return found;
}

} // namespace taut::impl
