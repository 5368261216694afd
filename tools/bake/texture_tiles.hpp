// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include <taut/bake.hpp>

#include "bake/textured_surface.hpp"

namespace taut::tools
{

/// The tile of UDIM that a triangle is in, by the middle of its box: number 0 is 1001, ten in a row. None below or left
/// of the first tile, right of the tenth, or without a place.
std::optional<idx> tile_of(const std::array<vec2, 3>& uv);

/// Lower left corner of a tile.
vec2 corner_of(idx tile);

/// The tiles that triangles are in.
std::set<idx> tiles_of(const corner_uv& uv);

/// Triangles of an atlas in tiles, or in one texture for all, which is tile 0.
struct tiled_uv
{
    const corner_uv& uv;
    bool several = false; ///< whether tiles have textures of their own
};

/// Triangles by the tile of the new atlas that they reach into, and that of the old one that they are in.
using triangles_of_tiles = std::map<idx, std::map<idx, std::vector<idx>>>;

/// Those with a place in both atlases. A new tile is one that a triangle is in.
triangles_of_tiles triangles_by_tiles(const tiled_uv& old, const tiled_uv& next);

/// How many triangles of an atlas lie outside of its textures, all or in part: of its tiles, or of the unit square.
std::size_t count_outside(const tiled_uv& atlas);

/// Takes over texels that are in triangles, and those near to them where there are no others.
void merge(baked_texture& into, const baked_texture& part);

} // namespace taut::tools
