// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include <taut/impl/bake/bake.hpp>

namespace taut::tools
{

using corner_uv = std::vector<std::array<vec2, 3>>;

/// Textures by tile of UDIM: number 0 is 1001, ten in a row; or one for all, as 0.
struct tile_set
{
    bool several = false; ///< whether tiles have textures of their own
    std::map<idx, texture> images;
};

/// The tiles that triangles are in, each by the middle of its box; one that leaves its tile counts as of that. None of
/// triangles below or left of the first tile, or right of the tenth.
std::set<idx> tiles_of(const corner_uv& uv);

/// Triangles of a tile, moved to the unit square; others without a place.
corner_uv in_tile(const corner_uv& uv, idx tile);

/// Makes the textures of tiles: each from all old ones that its triangles have a place in.
/// several: whether each of the tiles of `to` gets one; else the first alone
/// bake: makes one of one, as taut::bake() does
std::map<idx, baked_texture>
bake_tiles(const tile_set& old, const corner_uv& from, const corner_uv& to, bool several, const bake_params& params,
           const std::function<baked_texture(const texture&, const corner_uv&, const bake_params&)>& bake);

} // namespace taut::tools
