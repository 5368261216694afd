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

#include <taut/impl/charts/packing/occupancy.hpp>
#include <taut/impl/charts/packing/pieces.hpp>
#include <taut/impl/charts/packing/raster.hpp>
#include <taut/impl/core/core/budget.hpp>

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

/// Cells within a gap of pieces in their poses, kept from one layout to the next.
class kept_halos
{
public:
    /// Of pieces that are drawn anew.
    void reset(std::size_t pieces)
    {
        rows_.clear();
        rows_.resize(pieces);
    }

    const cell_rows& of(const piece& p, const pose& at, std::size_t c, idx k, double cells_per_length, double gap)
    {
        if (gap != gap_) reset(rows_.size());
        gap_ = gap;
        auto& halo = rows_[c][k];
        if (halo.rows() == 0) halo = rasterize(posed_edges(p, at, cells_per_length), gap);
        return halo;
    }

private:
    std::vector<std::map<idx, cell_rows>> rows_; // of each piece, by pose
    double gap_ = 0;
};

/// Tiles that are not squares with an open end, and what is asked of a layout.
struct tile_rules
{
    idx rows = 0;                  ///< height of each tile in cells; 0: that of `side`, and the last one has no end
    std::span<const idx> groups{}; ///< the tile that each piece is to be in; empty: any
    std::span<const idx> only{};   ///< the pose that each piece is to have, -1: any; empty: any
    idx top = std::numeric_limits<idx>::max() / 2; ///< where a piece ends above this row, the layout is given up
};

/// Places pieces, in the order given, each in the pose whose top is lowest, as low as possible and then as far left, in
/// any gap.
/// side:  of a tile in cells; gap: minimum distance of two pieces in cells; before: cells occupied already
/// quick: a piece is not tried below the place of the last one of about its width and height
inline tile_layout lay_out(std::span<const piece> pieces, std::span<const std::vector<pose>> poses, kept_halos& halos,
                           std::span<const idx> order, idx side, idx tiles, double gap, double cells_per_length,
                           bool quick, budget& limits, std::span<const taken_cells> before = {},
                           const tile_rules& rules = {})
{
    const idx rows = rules.rows > 0 ? rules.rows : side;
    const bool bounded = rules.rows > 0;
    tile_layout out;
    out.spots.resize(pieces.size());
    occupancy taken(side); // tiles lie on each other, with a row between them
    for (idx t = 1; t < tiles; ++t) taken.block(t * (rows + 1) - 1);
    for (const taken_cells& wall : before) taken.take(wall.cells, 0, wall.tile * (rows + 1));
    const auto tile_of = [&](idx y) { return std::min(y / (rows + 1), tiles - 1); };
    std::map<std::pair<int, int>, idx> starts;
    for (std::size_t placed = 0; const idx i : order)
    {
        if (placed++ % 8 == 0 && !limits.proceed()) return out;
        const auto c = static_cast<std::size_t>(i);
        spot best;
        idx lowest = 0; // top of the best
        for (std::size_t k = 0; k < poses[c].size(); ++k)
        {
            if (!rules.only.empty() && rules.only[c] >= 0 && rules.only[c] != static_cast<idx>(k)) continue;
            const room_mask& mask = poses[c][k].mask;
            const idx height = mask.cells.height;
            if (mask.cells.width > side || ((tiles > 1 || bounded) && height > rows)) continue;
            const auto size = [](idx n) { return static_cast<int>(4 * std::log2(n)); };
            idx* const start = quick ? &starts[{size(mask.cells.width), size(height)}] : nullptr;
            const idx highest = (best.pose < 0 ? rules.top : lowest) - height;
            idx x = -1, y = start ? *start : 0;
            const idx own = rules.groups.empty() ? -1 : rules.groups[c], last = own < 0 ? tiles : own + 1;
            for (idx tile = own < 0 ? tile_of(y) : own; tile < last && x < 0; ++tile)
            {
                y = std::max(y, tile * (rows + 1));
                const bool open = tile == tiles - 1 && !bounded;
                const idx top = open ? highest : tile * (rows + 1) + rows - height;
                std::tie(y, x) = taken.find(mask, y, std::min(highest, top));
            }
            if (x < 0) continue;
            if (start) *start = y;
            if (best.pose < 0 || y + height < lowest || x < best.x) best = {static_cast<idx>(k), tile_of(y), x, y};
            lowest = y + height;
        }
        if (best.pose < 0) return out;
        const pose& at = poses[c][static_cast<std::size_t>(best.pose)];
        taken.take(halos.of(pieces[c], at, c, best.pose, cells_per_length, gap), best.x, best.y);
        best.y -= best.tile * (rows + 1);
        out.spots[c] = best;
    }
    out.complete = true;
    out.measure(poses);
    return out;
}

} // namespace taut::impl
