// SPDX-License-Identifier: MIT
#include "bake/texture_tiles.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "shared/at.hpp"

namespace taut::tools
{

namespace
{

struct box
{
    vec2 low, high;
    bool is_finite;

    explicit box(const std::array<vec2, 3>& t)
        : low(glm::min(t[0], glm::min(t[1], t[2]))), high(glm::max(t[0], glm::max(t[1], t[2]))), is_finite(has_place(t))
    {
    }

    /// Whether it has an area in common with a tile.
    bool meets(idx tile) const
    {
        const vec2 c = corner_of(tile);
        return low.x < c.x + 1 && low.y < c.y + 1 && high.x > c.x && high.y > c.y;
    }
};

constexpr idx across = 10, down = 100; // tiles

/// Calls f(tile) for the tiles of a set that a triangle reaches into.
template <class F>
void for_each_tile(const box& b, const std::set<idx>& tiles, F f)
{
    const auto clipped = [](double x, idx most)
    { return static_cast<idx>(std::clamp(std::floor(x), 0.0, most - 1.0)); };
    for (idx j = clipped(b.low.y, down); j <= clipped(b.high.y, down); ++j)
        for (idx i = clipped(b.low.x, across); i <= clipped(b.high.x, across); ++i)
            if (const idx tile = i + across * j; tiles.contains(tile) && b.meets(tile)) f(tile);
}

} // namespace

std::optional<idx> tile_of(const std::array<vec2, 3>& uv)
{
    const box b(uv);
    const vec2 tile = glm::floor(b.low / 2.0 + b.high / 2.0);
    if (!(tile.x >= 0 && tile.x < across && tile.y >= 0 && tile.y < down)) return {};
    return static_cast<idx>(tile.x) + across * static_cast<idx>(tile.y);
}

vec2 corner_of(idx tile)
{
    return {tile % across, tile / across};
}

std::set<idx> tiles_of(const corner_uv& uv)
{
    std::set<idx> tiles;
    for (const auto& t : uv)
        if (const auto tile = tile_of(t)) tiles.insert(*tile);
    return tiles;
}

triangles_of_tiles triangles_by_tiles(const tiled_uv& old, const tiled_uv& next)
{
    triangles_of_tiles found;
    const std::set<idx> tiles = next.several ? tiles_of(next.uv) : std::set<idx>{0};
    for (std::size_t f = 0; f < next.uv.size(); ++f)
    {
        const box b(next.uv[f]);
        if (!b.is_finite || !has_place(old.uv[f])) continue;
        const auto of_old = old.several ? tile_of(old.uv[f]) : std::optional<idx>(0);
        if (of_old) for_each_tile(b, tiles, [&](idx tile) { found[tile][*of_old].push_back(static_cast<idx>(f)); });
    }
    return found;
}

std::size_t count_outside(const tiled_uv& atlas)
{
    constexpr double rounding = 1e-5;
    return static_cast<std::size_t>(
        std::count_if(atlas.uv.begin(), atlas.uv.end(),
                      [&](const auto& t)
                      {
                          const box b(t);
                          const auto tile = atlas.several ? tile_of(t) : std::optional<idx>(0);
                          if (!b.is_finite) return false;
                          if (!tile) return true;
                          const vec2 low = corner_of(*tile) - rounding, high = corner_of(*tile) + (1 + rounding);
                          return b.low.x < low.x || b.low.y < low.y || b.high.x > high.x || b.high.y > high.y;
                      }));
}

void merge(baked_texture& into, const baked_texture& part)
{
    const auto channels = static_cast<std::size_t>(part.image.channels);
    for (std::size_t n = 0; n < part.covered.size(); ++n)
    {
        const bool better = part.covered[n] == 1 ? into.covered[n] != 1 : part.covered[n] == 2 && into.covered[n] == 0;
        if (!better) continue;
        into.covered[n] = part.covered[n];
        std::copy_n(&part.image.texels[n * channels], channels, &into.image.texels[n * channels]);
    }
}

} // namespace taut::tools
