// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/charts/paste/feature_map.hpp>
#include <taut/impl/charts/paste/surface/feature_refinement.hpp>
#include <taut/impl/charts/paste/surface/polygon_filling.hpp>
#include <taut/impl/core/core/padded.hpp>
#include <taut/paste.hpp>

namespace taut::impl
{

/// A square cell of a feature map, in texels.
struct map_cell
{
    float roughness = 0;
    idx i = 0, j = 0, size = 0;
    vec2 middle() const { return vec2(i + 0.5, j + 0.5) * double(size); }
    bool operator<(const map_cell& o) const { return roughness < o.roughness; }
};

/// Cells of 2 texels and more: the roughest one is split again and again, until `count` have their middle in the
/// feature or none is rougher than `tolerance`.
inline std::vector<map_cell> split_cells(queue& q, const feature_map& map, std::size_t count, double tolerance)
{
    const kernel measure = make_kernel(q, map_program(), "map_roughness");
    const buffer<float> texels(q, map.values);
    idx largest = 2;
    while (2 * largest < std::max(map.width, map.height)) largest *= 2;
    const auto across = [&](idx size) { return (map.width + size - 1) / size; };
    const auto down = [&](idx size) { return (map.height + size - 1) / size; };
    std::vector<std::vector<float>> roughness; // of sizes 2, 4, ...
    for (idx size = 2; size <= largest; size *= 2)
    {
        const auto cells = static_cast<std::size_t>(across(size)) * static_cast<std::size_t>(down(size));
        buffer<float> out(q, cells);
        measure({padded(cells, 64), 64}, {{"width", map.width},
                                          {"height", map.height},
                                          {"size", size},
                                          {"across", across(size)},
                                          {"count", static_cast<idx>(cells)},
                                          {"texels", texels},
                                          {"roughness", out}});
        roughness.push_back(out.download());
    }
    const auto cell_at = [&](std::size_t level, idx i, idx j, idx size) {
        return map_cell{roughness[level][static_cast<std::size_t>(j * across(size) + i)], i, j, size};
    };
    const auto is_inside = [&](const map_cell& c)
    {
        const vec2 p = c.middle();
        return p.x < map.width && p.y < map.height && map.covers(static_cast<idx>(p.x), static_cast<idx>(p.y));
    };
    std::priority_queue<map_cell> open;
    std::vector<map_cell> done;
    std::size_t inside = 0;
    const auto add = [&](const map_cell& c)
    {
        inside += is_inside(c) ? 1 : 0;
        if (c.size > 2 && c.roughness > tolerance)
            open.push(c);
        else
            done.push_back(c);
    };
    for (idx j = 0; j < down(largest); ++j)
        for (idx i = 0; i < across(largest); ++i) add(cell_at(roughness.size() - 1, i, j, largest));
    while (!open.empty() && inside < count)
    {
        const map_cell c = open.top();
        open.pop();
        inside -= is_inside(c) ? 1 : 0;
        std::size_t level = 0;
        while (idx(4) << level < c.size) ++level; // of half the size
        const idx half = c.size / 2;
        for (idx j = 2 * c.j; j < std::min(2 * c.j + 2, down(half)); ++j)
            for (idx i = 2 * c.i; i < std::min(2 * c.i + 2, across(half)); ++i) add(cell_at(level, i, j, half));
    }
    for (; !open.empty(); open.pop()) done.push_back(open.top());
    std::erase_if(done, [&](const map_cell& c) { return !is_inside(c); });
    return done;
}

} // namespace taut::impl

namespace taut
{

feature feature::tessellate(queue& q, const impl::feature_map& map, std::span<const vec2> uv, idx triangles) const
{
    if (triangles < 1) throw parameter_error("triangles", "must be positive");
    const auto& rim = region.rim;
    std::vector<vec2> polygon;
    std::vector<idx> loop;
    for (const idx v : rim)
    {
        loop.push_back(static_cast<idx>(polygon.size()));
        polygon.push_back(uv[static_cast<std::size_t>(v)]);
    }
    auto filling = impl::clip_ears(loop, polygon);
    if (filling.size() + 2 != rim.size())
        throw paste_error("the rim of the feature crosses itself in its map; parameterize it with the rim pinned");
    impl::plane_triangulation plane(polygon, std::move(filling));

    std::vector<vec3> points;
    for (const idx v : rim) points.push_back(region.surface.points()[static_cast<std::size_t>(v)]);
    const auto wanted = static_cast<std::size_t>(std::max<idx>(0, (triangles - static_cast<idx>(rim.size())) / 2));
    const double tolerance = 0.25 * map.footprint;
    std::vector<vec2> middles;
    for (const auto& c : impl::split_cells(q, map, wanted / 2, 0.01 * map.footprint))
    {
        const vec2 p = map.low + map.texel * c.middle();
        if (impl::distance_from(polygon, p) > 0.4 * c.size * map.texel) middles.push_back(p);
    }
    impl::feature_refinement refine(region.surface, uv, tolerance);
    const mat3 axes = frame();
    const auto sampled = impl::sample(q, map, middles);
    for (std::size_t i = 0; i < middles.size(); ++i)
    {
        const vec3 p = centre + axes * sampled[i];
        if (refine.distance(p) <= tolerance && plane.insert(middles[i])) points.push_back(p);
    }
    refine(plane, points, rim.size() + wanted);

    std::vector<idx> vertices(points.size(), -1);
    for (std::size_t i = 0; i < rim.size(); ++i) vertices[i] = region.vertices[static_cast<std::size_t>(rim[i])];
    std::vector<idx> faces(plane.triangles().size(), -1);
    return feature(
        {mesh<triangle>(std::move(points), plane.triangles()), std::move(vertices), std::move(faces), std::move(loop)});
}

} // namespace taut
