// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <queue>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/facets.hpp>

namespace taut::impl
{

/// A triangle laid in the plane, by its shape alone: corner 1 at the origin, corner 2 on the x-axis.
inline std::array<vec2, 3> laid_triangle(const mesh<triangle>& m, idx c)
{
    const auto x = m.rest(c);
    const vec3 edge = x[2] - x[1], way = x[0] - x[1];
    const double length = glm::length(edge);
    return {vec2(glm::dot(way, edge), glm::length(glm::cross(edge, way))) / length, vec2(0.0), vec2(length, 0.0)};
}

/// Unfolds a surface, whose facets are f, along the spanning tree of its dual graph with the longest edges: each
/// triangle is laid as it is beside its parent, and a vertex stays at its first place. An isometry of planes,
/// cylinders, cones and folded strips that are not closed around, and of nothing else: it may be folded there.
/// Angles are handed on from triangle to triangle, not taken from places of vertices: errors add up, but do not grow at
/// short edges, and long ones keep what lies across a strip together.
/// Returns one point a vertex; none where a number is not finite. O(n log n).
inline std::vector<vec2> unfolded(const mesh<triangle>& m, const facet_table& f)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    const auto turned = [](const vec2& a, const vec2& b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); };
    const auto direction = [](const std::array<vec2, 3>& x, std::size_t k)
    { return glm::normalize(x[(k + 2) % 3] - x[(k + 1) % 3]); };
    std::vector<vec2> uv(m.points().size(), vec2(0.0)), turn(m.cells().size(), vec2(1, 0)); // of laid triangles
    std::vector<char> placed(uv.size(), 0), taken(turn.size(), 0);
    std::priority_queue<std::pair<double, idx>> sides; // lengths, sides of triangles that are taken
    const auto take = [&](idx c, const std::array<vec2, 3>& x, std::size_t opposite)
    {
        taken[u(c)] = 1;
        const auto& t = m.cells()[u(c)];
        const std::size_t one = (opposite + 1) % 3, two = (opposite + 2) % 3;
        const std::size_t near = glm::distance(x[opposite], x[one]) < glm::distance(x[opposite], x[two]) ? one : two;
        if (std::exchange(placed[u(t[opposite])], char(1)) == 0)
            uv[u(t[opposite])] = uv[u(t[near])] + turned(turn[u(c)], x[opposite] - x[near]);
        for (std::size_t k = 0; k < 3; ++k)
            if (const idx twin = f.twin[3 * u(c) + k]; twin >= 0 && taken[u(twin / 3)] == 0)
                sides.emplace(glm::distance(x[(k + 1) % 3], x[(k + 2) % 3]), 3 * c + static_cast<idx>(k));
    };
    for (idx root = 0; root < m.cell_count(); ++root)
    {
        if (taken[u(root)] != 0) continue;
        const auto first = laid_triangle(m, root);
        for (const std::size_t k : {std::size_t(1), std::size_t(2)})
        {
            uv[u(m.cells()[u(root)][k])] = first[k];
            placed[u(m.cells()[u(root)][k])] = 1;
        }
        take(root, first, 0);
        while (!sides.empty())
        {
            const idx s = sides.top().second, twin = f.twin[u(s)];
            sides.pop();
            if (taken[u(twin / 3)] != 0) continue;
            const auto x = laid_triangle(m, twin / 3);
            const vec2 along = turned(turn[u(s / 3)], direction(laid_triangle(m, s / 3), u(s % 3)));
            const vec2 own = direction(x, u(twin % 3));
            turn[u(twin / 3)] = glm::normalize(turned(-along, vec2(own.x, -own.y)));
            take(twin / 3, x, u(twin % 3));
        }
    }
    const auto finite = [](const vec2& p) { return std::isfinite(p.x) && std::isfinite(p.y); };
    if (!std::all_of(uv.begin(), uv.end(), finite)) uv.clear();
    return uv;
}

} // namespace taut::impl
