// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/impl/core/budget.hpp>
#include <taut/impl/packing/occupancy.hpp>
#include <taut/impl/packing/pieces.hpp>
#include <taut/impl/packing/raster.hpp>

namespace taut::impl
{

/// Placement of a piece: its pose, the tile, and the cell of the tile that its mask begins at.
struct spot
{
    idx pose = -1, tile = 0, x = 0, y = 0;
};

/// Layout of pieces in tiles of equal width; the last one is as high as needed.
struct tile_layout
{
    std::vector<spot> spots;
    double width = 0, height = 0; ///< occupied extent in cells: the maximum over all tiles; of the last one
    idx tiles = 1;                ///< in use
    bool complete = false;        ///< false: a piece is wider than a tile, or the budget is over

    /// Lengths from the extents of the placed pieces.
    void measure(std::span<const std::vector<pose>> poses)
    {
        width = height = 0;
        tiles = 1;
        for (const spot& s : spots) tiles = std::max(tiles, s.tile + 1);
        for (std::size_t c = 0; c < spots.size(); ++c)
        {
            const spot& s = spots[c];
            const vec2 size = poses[c][static_cast<std::size_t>(s.pose)].size;
            width = std::max(width, s.x + size.x + inset);
            if (s.tile + 1 == tiles)
                height = std::max(height, s.y + size.y + inset);
            else
                width = std::max(width, s.y + size.y + inset);
        }
    }
};

/// Cells of one tile that are occupied before packing.
struct taken_cells
{
    idx tile = 0;
    cell_rows cells;
};

/// Places pieces, in the order given, each in the pose whose top is lowest, as low as possible and then as far left, in
/// any gap.
/// side:  of a tile in cells; gap: minimum distance of two pieces in cells; before: cells occupied already
/// quick: a piece is not tried below the place of the last one of about its width and height
inline tile_layout lay_out(std::span<const piece> pieces, std::span<const std::vector<pose>> poses,
                           std::span<const idx> order, idx side, idx tiles, double gap, double cells_per_length,
                           bool quick, budget& limits, std::span<const taken_cells> before = {})
{
    tile_layout out;
    out.spots.resize(pieces.size());
    occupancy taken(side); // tiles lie on each other, with a row between them
    for (idx t = 1; t < tiles; ++t) taken.block(t * (side + 1) - 1);
    for (const taken_cells& wall : before) taken.take(wall.cells, 0, wall.tile * (side + 1));
    const auto tile_of = [&](idx y) { return std::min(y / (side + 1), tiles - 1); };
    std::map<std::pair<int, int>, idx> starts;
    for (std::size_t placed = 0; const idx i : order)
    {
        if (placed++ % 8 == 0 && !limits.proceed()) return out;
        const auto c = static_cast<std::size_t>(i);
        spot best;
        idx lowest = 0; // top of the best
        for (std::size_t k = 0; k < poses[c].size(); ++k)
        {
            const room_mask& mask = poses[c][k].mask;
            const idx height = mask.cells.height;
            if (mask.cells.width > side || (tiles > 1 && height > side)) continue;
            const auto size = [](idx n) { return static_cast<int>(4 * std::log2(n)); };
            idx* const start = quick ? &starts[{size(mask.cells.width), size(height)}] : nullptr;
            const idx highest = best.pose < 0 ? std::numeric_limits<idx>::max() / 2 : lowest - height;
            idx x = -1, y = start ? *start : 0;
            for (idx tile = tile_of(y); tile < tiles && x < 0; ++tile)
            {
                y = std::max(y, tile * (side + 1));
                const idx top = tile == tiles - 1 ? highest : tile * (side + 1) + side - height;
                std::tie(y, x) = taken.find(mask, y, std::min(highest, top));
            }
            if (x < 0) continue;
            if (start) *start = y;
            if (best.pose < 0 || y + height < lowest || x < best.x) best = {static_cast<idx>(k), tile_of(y), x, y};
            lowest = y + height;
        }
        if (best.pose < 0) return out;
        const pose& at = poses[c][static_cast<std::size_t>(best.pose)];
        taken.take(rasterize(posed_edges(pieces[c], at, cells_per_length), gap), best.x, best.y);
        best.y -= best.tile * (side + 1);
        out.spots[c] = best;
    }
    out.complete = true;
    out.measure(poses);
    return out;
}

} // namespace taut::impl
