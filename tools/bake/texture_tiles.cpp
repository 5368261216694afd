// SPDX-License-Identifier: MIT
#include "bake/texture_tiles.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include <taut/impl/bake/fill_gutters.hpp>

namespace taut::tools
{

namespace
{

std::optional<idx> tile_of(const std::array<vec2, 3>& t)
{
    const vec2 low = glm::min(t[0], glm::min(t[1], t[2])), high = glm::max(t[0], glm::max(t[1], t[2]));
    const vec2 tile = glm::floor(low / 2.0 + high / 2.0);
    if (!(tile.x >= 0 && tile.x < 10 && tile.y >= 0 && tile.y < 100)) return {};
    return static_cast<idx>(tile.x) + 10 * static_cast<idx>(tile.y);
}

vec2 corner_of(idx tile)
{
    return {tile % 10, tile / 10};
}

/// Takes over texels that are in triangles, and those near to them where there are no others.
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

} // namespace

std::set<idx> tiles_of(const corner_uv& uv)
{
    std::set<idx> tiles;
    for (const auto& t : uv)
        if (const auto tile = tile_of(t)) tiles.insert(*tile);
    return tiles;
}

corner_uv in_tile(const corner_uv& uv, idx tile)
{
    corner_uv moved(uv);
    for (auto& t : moved)
        if (tile_of(t) == tile)
            for (vec2& x : t) x -= corner_of(tile);
        else
            t.fill(vec2(std::numeric_limits<double>::quiet_NaN()));
    return moved;
}

std::map<idx, baked_texture>
bake_tiles(const tile_set& old, const corner_uv& from, const corner_uv& to, bool several, const bake_params& params,
           const std::function<baked_texture(const texture&, const corner_uv&, const bake_params&)>& bake)
{
    std::map<idx, baked_texture> result;
    for (const idx tile : several ? tiles_of(to) : std::set<idx>{0})
    {
        bake_params own = params;
        own.origin = corner_of(tile);
        if (!old.several)
        {
            result.emplace(tile, bake(old.images.begin()->second, from, own));
            continue;
        }
        own.wrap = texture::wrap::clamp;
        own.gutter = 0;
        for (const auto& [number, image] : old.images)
        {
            if (own.width == 0) own.width = image.width;
            if (own.height == 0) own.height = image.height;
            auto part = bake(image, in_tile(from, number), own);
            if (const auto at = result.find(tile); at != result.end())
                merge(at->second, part);
            else
                result.emplace(tile, std::move(part));
        }
        baked_texture& made = result.at(tile);
        impl::fill_gutters(made.image, made.covered, params.gutter);
    }
    return result;
}

} // namespace taut::tools
