// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/charts/paste/attach/landing.hpp>
#include <taut/impl/charts/paste/surface/face_set.hpp>
#include <taut/impl/charts/paste/surface/plane_triangulation.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Seam of a paste: the triangles removed to make room for a polygon, and those between the remaining ones and the
/// polygon.
struct seam
{
    std::vector<char> removed;               ///< of the triangles of the place, flags
    std::vector<std::array<idx, 3>> filling; ///< vertices of the place, then those of the polygon
};

/// Flags of the triangles that come within `margin` of the polygon or lie in it.
inline std::vector<char> near_or_inside(const landing_place& place, std::span<const vec2> polygon, double margin)
{
    const auto& cells = place.region.surface.cells();
    std::vector<char> vertex(place.uv.size()), face(cells.size());
    parallel_for(vertex.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t v = begin; v < end; ++v)
                         vertex[v] = encloses(polygon, place.uv[v]) || distance_from(polygon, place.uv[v]) < margin;
                 });
    vec2 low = polygon[0], high = polygon[0];
    for (const vec2& p : polygon)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const auto crossed = [&](const vec2& a, const vec2& b)
    {
        const vec2 l = glm::min(a, b), h = glm::max(a, b);
        if (h.x < low.x || l.x > high.x || h.y < low.y || l.y > high.y) return false;
        for (std::size_t i = 0; i < polygon.size(); ++i)
        {
            const vec2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
            if (std::max(p.x, q.x) < l.x || std::min(p.x, q.x) > h.x || std::max(p.y, q.y) < l.y ||
                std::min(p.y, q.y) > h.y)
                continue;
            if (segments_meet(a, b, p, q)) return true;
        }
        return false;
    };
    parallel_for(cells.size(),
                 [&](std::size_t begin, std::size_t end)
                 {
                     for (std::size_t f = begin; f < end; ++f)
                     {
                         std::array<vec2, 3> x;
                         for (std::size_t k = 0; k < 3; ++k)
                         {
                             const auto v = static_cast<std::size_t>(cells[f][k]);
                             x[k] = place.uv[v];
                             if (vertex[v]) face[f] = 1;
                         }
                         for (std::size_t k = 0; k < 3 && !face[f]; ++k) face[f] = crossed(x[k], x[(k + 1) % 3]);
                         if (!face[f]) face[f] = encloses(x, polygon[0]); // all of the polygon in one triangle
                     }
                 });
    return face;
}

/// Makes room for a polygon: takes out the triangles of the place that it covers or comes near, with what they enclose,
/// and fills the gap with a constrained Delaunay triangulation. Throws paste_error where that reaches the rim of the
/// place.
inline seam make_seam(const landing_place& place, std::span<const vec2> polygon)
{
    const auto& surface = place.region.surface;
    double edges = 0; // mean length in the map
    for (const auto& t : surface.cells())
        for (std::size_t k = 0; k < 3; ++k)
            edges += glm::distance(place.uv[static_cast<std::size_t>(t[k])],
                                   place.uv[static_cast<std::size_t>(t[(k + 1) % 3])]) /
                     (3.0 * static_cast<double>(surface.cells().size()));
    seam s{.removed = near_or_inside(place, polygon, 0.3 * edges), .filling = {}};

    const auto sides = facets(surface);
    face_set hole(surface, sides);
    for (std::size_t f = 0; f < s.removed.size(); ++f)
        if (s.removed[f]) hole.add(static_cast<idx>(f));
    hole.widen();
    const auto too_near = []
    {
        throw paste_error(
            "the feature comes too near to the end of the surface around the target vertex; choose another "
            "vertex, a smaller scale or a larger reach");
    };
    std::vector<std::array<idx, 2>> open;
    for (idx f = 0; f < surface.cell_count(); ++f)
    {
        s.removed[static_cast<std::size_t>(f)] = hole.has(f);
        if (!hole.has(f)) continue;
        for (idx side = 3 * f; side < 3 * f + 3; ++side)
        {
            const idx g = hole.across(side);
            if (g < 0) too_near();
            if (!hole.has(g)) open.push_back(side_vertices(surface, side));
        }
    }
    // One loop, for the hole is a disk without pinches.
    std::vector<idx> next(surface.points().size(), -1), loop;
    for (const auto& e : open) next[static_cast<std::size_t>(e[0])] = e[1];
    for (idx v = open.at(0)[0]; loop.empty() || v != loop[0]; v = next[static_cast<std::size_t>(v)]) loop.push_back(v);
    if (loop.size() != open.size()) too_near();
    // Beyond the rim of the place nobody has looked for edges between vertices of the loop.
    const auto on_rim = boundary_flags(surface.points().size(), std::span(&place.region.rim, 1));
    for (const idx v : loop)
        if (on_rim[static_cast<std::size_t>(v)]) too_near();

    auto x = place.uv;
    std::vector<idx> inner;
    for (const vec2& p : polygon)
    {
        inner.push_back(static_cast<idx>(x.size()));
        x.push_back(p);
    }
    const auto gap = bridged(loop, inner, x);
    auto triangles = clip_ears(gap, x);
    if (gap.empty() || triangles.size() + 2 != gap.size()) too_near();
    s.filling = plane_triangulation(std::move(x), std::move(triangles)).triangles();
    return s;
}

} // namespace taut::impl
