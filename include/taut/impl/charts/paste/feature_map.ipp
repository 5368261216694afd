// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>

#include <taut/impl/charts/paste/feature_map.hpp>
#include <taut/impl/core/compute/host/programs.hpp>
#include <taut/impl/core/compute/kernel.hpp>
#include <taut/impl/core/compute/kernels/feature_map.hpp>
#include <taut/impl/core/core/csr.hpp>
#include <taut/impl/core/core/padded.hpp>
#include <taut/queue.hpp>

namespace taut::impl
{

inline own_program map_program()
{
    return {.text = kernels::feature_map, .host = host_feature_map, .settings = {}};
}

inline std::vector<float> floats_of(std::span<const vec2> points)
{
    std::vector<float> numbers;
    for (const vec2& p : points) numbers.insert(numbers.end(), {static_cast<float>(p.x), static_cast<float>(p.y)});
    return numbers;
}

constexpr idx map_tile = 16; ///< texels along the side of a tile

/// The triangles whose box meets each tile.
inline csr triangles_by_tile(std::span<const vec2> corners, idx across, idx down)
{
    std::vector<std::vector<idx>> rows(static_cast<std::size_t>(across * down));
    for (std::size_t f = 0; 3 * f < corners.size(); ++f)
    {
        const vec2 &a = corners[3 * f], &b = corners[3 * f + 1], &c = corners[3 * f + 2];
        const vec2 low = glm::min(a, glm::min(b, c)) - 0.5, high = glm::max(a, glm::max(b, c)) + 0.5;
        const auto tile_of = [](double x, idx most) { return std::clamp(static_cast<idx>(x) / map_tile, 0, most - 1); };
        for (idx j = tile_of(low.y, down); j <= tile_of(high.y, down); ++j)
            for (idx i = tile_of(low.x, across); i <= tile_of(high.x, across); ++i)
                rows[static_cast<std::size_t>(j * across + i)].push_back(static_cast<idx>(f));
    }
    csr tiles{{0}, {}};
    for (const auto& row : rows)
    {
        tiles.items.insert(tiles.items.end(), row.begin(), row.end());
        tiles.offsets.push_back(static_cast<idx>(tiles.items.size()));
    }
    if (tiles.items.empty()) tiles.items.push_back(0);
    return tiles;
}

std::vector<vec3> sample(queue& q, const feature_map& map, std::span<const vec2> points)
{
    if (points.empty()) return {};
    std::vector<vec2> at;
    for (const vec2& p : points) at.push_back(map.in_texels(p));
    const buffer<float> texels(q, map.values), places(q, impl::floats_of(at));
    buffer<float> positions(q, 3 * points.size());
    const kernel run = make_kernel(q, impl::map_program(), "map_sample");
    run({padded(points.size(), 64), 64}, {{"count", static_cast<idx>(points.size())},
                                          {"width", map.width},
                                          {"height", map.height},
                                          {"texels", texels},
                                          {"points", places},
                                          {"positions", positions}});
    const auto numbers = positions.download();
    std::vector<vec3> result;
    for (std::size_t n = 0; n < points.size(); ++n)
        result.emplace_back(double(numbers[3 * n]), double(numbers[3 * n + 1]), double(numbers[3 * n + 2]));
    return result;
}

/// A map without values that has the places of a feature, and a margin around them.
inline feature_map empty_map(std::span<const vec2> uv, idx resolution, idx margin)
{
    vec2 low = uv[0], high = uv[0];
    for (const vec2& p : uv)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    feature_map map;
    const vec2 extent = high - low;
    map.texel = std::max(extent.x, extent.y) / static_cast<double>(resolution - 2 * margin);
    map.low = low - map.texel * margin;
    map.width = static_cast<idx>(std::ceil(extent.x / map.texel)) + 2 * margin;
    map.height = static_cast<idx>(std::ceil(extent.y / map.texel)) + 2 * margin;
    return map;
}

/// Notes how far the samples at the vertices are from them.
inline void measure_round_trip(feature_map& map, std::span<const vec3> sampled, std::span<const vec3> points,
                               const feature& part)
{
    const mat3 to_frame = glm::transpose(part.frame());
    for (std::size_t v = 0; v < sampled.size(); ++v)
    {
        const double d = glm::distance(sampled[v], to_frame * (points[v] - part.centre));
        map.round_trip = std::max(map.round_trip, d);
        map.round_trip_rms += d * d / static_cast<double>(sampled.size());
    }
    map.round_trip_rms = std::sqrt(map.round_trip_rms);
}

} // namespace taut::impl

namespace taut
{

impl::feature_map feature::rasterize(queue& q, std::span<const vec2> uv, idx resolution) const
{
    if (resolution < 8 || resolution > 8192) throw parameter_error("resolution", "must be from 8 to 8192");
    const idx margin = std::min<idx>(4, resolution / 4);
    const auto& surface = region.surface;
    if (uv.size() != surface.points().size())
        throw parameter_error("uv", std::to_string(uv.size()) + " places for " +
                                        std::to_string(surface.points().size()) + " vertices; give one per vertex");
    impl::feature_map map = impl::empty_map(uv, resolution, margin);
    const mat3 to_frame = glm::transpose(frame());
    std::vector<vec2> corners;
    std::vector<float> positions;
    double area = 0, area_in_map = 0;
    for (idx f = 0; f < surface.cell_count(); ++f)
    {
        const auto x = surface.rest(f);
        for (std::size_t k = 0; k < 3; ++k)
        {
            corners.push_back(
                map.in_texels(uv[static_cast<std::size_t>(surface.cells()[static_cast<std::size_t>(f)][k])]));
            const vec3 p = to_frame * (x[k] - centre);
            positions.insert(positions.end(),
                             {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
        }
        const vec2 a = corners.end()[-2] - corners.end()[-3], b = corners.end()[-1] - corners.end()[-3];
        area += glm::length(glm::cross(x[1] - x[0], x[2] - x[0]));
        area_in_map += std::abs(a.x * b.y - a.y * b.x);
    }
    map.footprint = std::sqrt(area / area_in_map);

    const idx across = (map.width + impl::map_tile - 1) / impl::map_tile;
    const idx down = (map.height + impl::map_tile - 1) / impl::map_tile;
    const impl::csr tiles = impl::triangles_by_tile(corners, across, down);
    const std::size_t count = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
    const buffer<idx> starts(q, tiles.offsets), items(q, tiles.items);
    const buffer<float> places(q, impl::floats_of(corners)), values(q, positions);
    buffer<float> texels(q, 4 * count), next(q, 4 * count);
    const kernel cover = make_kernel(q, impl::map_program(), "map_cover");
    const kernel go_on = make_kernel(q, impl::map_program(), "map_continue");
    const range all(impl::padded(count, 64), 64);
    cover(all, {{"width", map.width},
                {"height", map.height},
                {"tile", impl::map_tile},
                {"tiles_across", across},
                {"starts", starts},
                {"items", items},
                {"uv", places},
                {"positions", values},
                {"texels", texels}});
    for (idx round = 0; round < margin; ++round)
    {
        go_on(all, {{"width", map.width}, {"height", map.height}, {"from", texels}, {"to", next}});
        texels.swap(next);
    }
    map.values = texels.download();

    impl::measure_round_trip(map, impl::sample(q, map, uv), surface.points(), *this);
    return map;
}

} // namespace taut
