// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/packing/detail/pieces.hpp>
#include <taut/packing/packing_error.hpp>

namespace taut::detail
{

/// Boxes in rows, the high ones first: corners in tiles of side 1.
struct shelf_layout
{
    double scale = 0; ///< of the boxes; 0: there is no room
    std::vector<vec2> corners;
    std::vector<idx> tiles;
};

/// border, gap: to the border of a tile and between boxes
inline shelf_layout lay_on_shelves(std::span<const piece> pieces, std::span<const idx> by_height, double scale,
                                   idx tiles, double border, double gap)
{
    shelf_layout out{scale, std::vector<vec2>(pieces.size()), std::vector<idx>(pieces.size())};
    const double end = 1 - border;
    double x = border, y = border, shelf = 0;
    idx tile = 0;
    for (const idx i : by_height)
    {
        const auto c = static_cast<std::size_t>(i);
        const vec2 size = scale * pieces[c].box;
        if (x + size.x > end && x > border)
        {
            x = border;
            y += shelf + gap;
            shelf = 0;
        }
        if (y + size.y > end && y > border)
        {
            x = y = border;
            shelf = 0;
            ++tile;
        }
        if (x + size.x > end || y + size.y > end || tile == tiles) return {};
        out.corners[c] = {x, y};
        out.tiles[c] = tile;
        x += size.x + gap;
        shelf = std::max(shelf, size.y);
    }
    return out;
}

/// A layout that costs next to nothing, to have one: at the largest scale that halving finds.
/// Throws packing_error where the gaps alone fill the tiles.
inline shelf_layout lay_on_shelves(std::span<const piece> pieces, idx tiles, double border, double gap)
{
    std::vector<idx> order(pieces.size());
    std::iota(order.begin(), order.end(), idx{0});
    const auto at = [&](idx c) -> const piece& { return pieces[static_cast<std::size_t>(c)]; };
    std::stable_sort(order.begin(), order.end(), [&](idx a, idx b) { return at(a).box.y > at(b).box.y; });
    double most = 0;
    for (const piece& p : pieces) most = std::max({most, p.box.x, p.box.y});
    shelf_layout best;
    double high = 1 / most, low = high;
    for (int step = 0; step < 60 && !(best.scale > 0); ++step, low /= 2)
        best = lay_on_shelves(pieces, order, low, tiles, border, gap);
    if (!(best.scale > 0))
        throw packing_error(packing_fault::no_room, {},
                            "the padding around " + std::to_string(pieces.size()) + " charts takes all of " +
                                std::to_string(tiles) + " tile" + (tiles > 1 ? "s" : "") +
                                "; ask for less padding, a higher resolution or more tiles");
    low = best.scale;
    high = std::min(high, 2 * low);
    for (int step = 0; step < 10; ++step) // to a thousandth
    {
        auto next = lay_on_shelves(pieces, order, (low + high) / 2, tiles, border, gap);
        (next.scale > 0 ? low : high) = (low + high) / 2;
        if (next.scale > 0) best = std::move(next);
    }
    return best;
}

} // namespace taut::detail
