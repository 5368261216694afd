// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/charts/packing/pieces.hpp>

namespace taut::impl
{

/// Shelf layout of boxes, the high ones first: corners in tiles of side 1.
struct shelf_layout
{
    double scale = 0; ///< scale of the boxes; 0: there is no room
    std::vector<vec2> corners;
    std::vector<idx> tiles;
};

/// boxes: the high ones first; border, gap: to the border of a tile and between boxes
inline shelf_layout lay_on_shelves(std::span<const vec2> boxes, double scale, idx tiles, double border, double gap)
{
    shelf_layout out{scale, std::vector<vec2>(boxes.size()), std::vector<idx>(boxes.size())};
    const double end = 1 - border;
    double x = border, y = border, shelf = 0;
    idx tile = 0;
    for (std::size_t c = 0; c < boxes.size(); ++c)
    {
        const vec2 size = scale * boxes[c];
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

/// Computes a cheap shelf layout at the largest scale, by bisection.
/// Throws packing_error where the gaps alone fill the tiles.
inline shelf_layout lay_on_shelves(std::span<const piece> pieces, idx tiles, double border, double gap)
{
    std::vector<std::pair<double, idx>> order; // by height
    for (std::size_t c = 0; c < pieces.size(); ++c) order.emplace_back(-pieces[c].box.y, static_cast<idx>(c));
    std::sort(order.begin(), order.end());
    std::vector<vec2> boxes;
    double most = 0;
    for (const auto& [height, c] : order)
    {
        boxes.push_back(pieces[static_cast<std::size_t>(c)].box);
        most = std::max({most, boxes.back().x, boxes.back().y});
    }
    shelf_layout best;
    double high = 1 / most, low = high;
    for (int step = 0; step < 60 && !(best.scale > 0); ++step, low /= 2)
        best = lay_on_shelves(boxes, low, tiles, border, gap);
    if (!(best.scale > 0))
        throw packing_error(packing_error::no_room, {},
                            "the padding around " + std::to_string(pieces.size()) + " charts takes all of " +
                                std::to_string(tiles) + " tile" + (tiles > 1 ? "s" : "") +
                                "; ask for less padding, a higher resolution or more tiles");
    low = best.scale;
    high = std::min(high, 2 * low);
    for (int step = 0; step < 10; ++step) // to a thousandth
    {
        auto next = lay_on_shelves(boxes, (low + high) / 2, tiles, border, gap);
        (next.scale > 0 ? low : high) = (low + high) / 2;
        if (next.scale > 0) best = std::move(next);
    }
    shelf_layout by_piece = best;
    for (std::size_t k = 0; k < order.size(); ++k)
    {
        const auto c = static_cast<std::size_t>(order[k].second);
        by_piece.corners[c] = best.corners[k];
        by_piece.tiles[c] = best.tiles[k];
    }
    return by_piece;
}

} // namespace taut::impl
