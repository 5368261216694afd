// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <taut/impl/charts/packing/grid_packer.hpp>
#include <taut/impl/charts/packing/layout.hpp>
#include <taut/impl/charts/packing/outlines.hpp>
#include <taut/impl/charts/packing/pack.hpp>
#include <taut/impl/charts/packing/pieces.hpp>
#include <taut/impl/charts/packing/shelves.hpp>
#include <taut/impl/core/core/budget.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/pack.hpp>

namespace taut::impl
{

/// One run of the packer: layouts are tried one after the other, and the one with the largest scale is kept.
class packer
{
public:
    packer(std::span<const piece> pieces, const pack_params& params, const run_limits& limits, packing_effort effort,
           double enough)
        : pieces_(pieces),
          params_(params),
          effort_(effort),
          enough_(enough),
          limits_(limits.time_limit, limits.observer),
          tiles_(params.walls.empty() ? std::min(params.tiles, static_cast<int>(pieces.size())) : params.tiles)
    {
        for (const piece& p : pieces_)
        {
            area_ += p.area;
            length_ += p.length;
        }
        // Two points may come nearer by the rounding of both, and a place is off by its own.
        gap_ = params.padding / params.resolution + 2 * std::numbers::sqrt2 * params.rounding + 1e-12;
        border_ = params.padding / params.resolution + params.rounding + 1e-12;
        packed_.places.resize(pieces_.size());
    }

    packing run()
    {
        on_shelves();
        packed_.complete = limits_.proceed();
        if (!packed_.complete) return std::move(packed_);
        if (!params_.walls.empty())
        {
            search_around_walls();
            packed_.complete = !limits_.over();
            return std::move(packed_);
        }
        // Of many pieces quarter turns are enough; few, or one that is longer than a tile could be, need more.
        double longest = 0;
        for (const piece& p : pieces_) longest = std::max({longest, p.box.x, p.box.y});
        constexpr std::size_t few = 16;
        const double side = estimated_side();
        // A coarse grid leads to other layouts, of few pieces now and then to better ones, in little time.
        if (effort_ == packing_effort::full && params_.rotate && pieces_.size() <= few)
        {
            trial_ = true;
            search(std::max(side, longest), 8);
        }
        trial_ = effort_ != packing_effort::full;
        search(std::max(side, longest), !params_.rotate ? 1 : pieces_.size() <= 200 ? 8 : 4);
        const double wider = std::max(side, longest / std::numbers::sqrt2);
        if (params_.rotate && !trial_ && (pieces_.size() <= few || longest > 0.8 * side)) search(wider, 16);
        if (params_.rotate && !trial_ && pieces_.size() <= few / 2) search(wider, 64);
        packed_.complete = !limits_.over();
        return std::move(packed_);
    }

private:
    double gap_in_cells(double side) const { return gap_ * side / (1 - 2 * border_) + doubt_; }

    void on_shelves()
    {
        const bool walled = !params_.walls.empty();
        const auto [corner, side, tile] = walled ? free_square() : tile_square{};
        const auto shelves = lay_on_shelves(pieces_, walled ? 1 : tiles_, walled ? 0 : border_, gap_ / side);
        const double scale = side * shelves.scale;
        for (std::size_t c = 0; c < pieces_.size(); ++c)
        {
            const vec2 low = box_in(pieces_[c].hull, pieces_[c].axis)[0];
            place(c, pieces_[c].axis, scale, corner + side * shelves.corners[c] - scale * low, tile + shelves.tiles[c]);
        }
        scaled(scale);
    }

    /// A square of a tile.
    struct tile_square
    {
        vec2 corner{0, 0};
        double side = 1;
        idx tile = 0;
    };

    /// Approximately largest free square at the distance of pieces from the walls and the border.
    tile_square free_square() const
    {
        constexpr idx cells = 512;
        const double cell = (1 - 2 * border_) / cells;
        tile_square best{vec2(0.0), 0, 0};
        const auto walls = walls_in(cells);
        for (idx tile = 0; tile < params_.tiles; ++tile)
        {
            std::vector<char> taken(static_cast<std::size_t>(cells) * cells, 0);
            const auto at = [](idx x, idx y)
            { return static_cast<std::size_t>(y) * cells + static_cast<std::size_t>(x); };
            for (const taken_cells& wall : walls)
                for (idx r = 0; wall.tile == tile && r < wall.cells.rows(); ++r)
                    for (const cell_run& run : wall.cells.row(r))
                        for (idx x = std::max<idx>(0, run.begin), y = r + wall.cells.low;
                             y >= 0 && y < cells && x < std::min(cells, run.end); ++x)
                            taken[at(x, y)] = 1;
            // The side of the largest free square that ends in a cell follows from those that end before it.
            std::vector<idx> sides(taken.size(), 0);
            for (idx y = 0; y < cells; ++y)
                for (idx x = 0; x < cells; ++x)
                {
                    if (taken[at(x, y)]) continue;
                    idx& side = sides[at(x, y)];
                    side = x > 0 && y > 0
                               ? 1 + std::min({sides[at(x - 1, y)], sides[at(x, y - 1)], sides[at(x - 1, y - 1)]})
                               : 1;
                    if (side * cell > best.side)
                        best = {vec2(border_) + cell * vec2(x + 1 - side, y + 1 - side), side * cell, tile};
                }
        }
        if (best.side > 0) return best;
        throw packing_error(packing_error::no_room, {},
                            "pinned charts leave no room for others; pin fewer, or ask for more tiles");
    }

    /// The cells of the walls, and of what is as near to them as pieces may not be, in tiles of so many cells per side.
    std::vector<taken_cells> walls_in(idx side) const
    {
        std::vector<std::vector<std::array<vec2, 2>>> edges(static_cast<std::size_t>(params_.tiles));
        const double cells = side / (1 - 2 * border_);
        const auto in_cells = [&](const vec2& x) { return cells * (x - vec2(border_)); };
        for (const tile_wall& wall : params_.walls)
            edges[static_cast<std::size_t>(wall.tile)].push_back({in_cells(wall.edge[0]), in_cells(wall.edge[1])});
        std::vector<taken_cells> taken;
        for (std::size_t tile = 0; tile < edges.size(); ++tile)
            if (!edges[tile].empty())
                taken.push_back({static_cast<idx>(tile), rasterize(edges[tile], gap_in_cells(side))});
        return taken;
    }

    /// Bisects between a side of the tiles at which pieces do not fit beside the walls, and one at which they do: walls
    /// grow with the tiles.
    void search_around_walls()
    {
        const bool quick = pieces_.size() > 1500;
        const double side_of_all = estimated_side();
        const idx cells = std::clamp(static_cast<idx>(90 * std::sqrt(static_cast<double>(pieces_.size()))), 512, 2048);
        draw(cells / side_of_all, !params_.rotate ? 1 : pieces_.size() <= 200 ? 8 : 4);
        idx fails = 0, fits = 0;
        tile_layout best;
        for (idx side = cells; side <= 4 * cells && !limits_.over();)
        {
            tile_layout l = lay_out(pieces_, poses_, halos_, order_, side, params_.tiles, gap_in_cells(side),
                                    cells_per_length_, quick, limits_, walls_in(side));
            ++packed_.layouts;
            if (l.complete && std::max(l.width, l.height) <= side)
            {
                fits = side;
                best = std::move(l);
            }
            else
                fails = side;
            if (fits > 0 && fits - fails <= std::max<idx>(1, fits / 100)) break;
            side = fits == 0 ? side + side / 3 : fails == 0 ? side - side / 4 : (fits + fails) / 2;
        }
        if (best.complete) keep(best, fits);
    }

    /// Estimated side of a tile, in lengths of the pieces: side^2 = (area + gaps around) / density, where a gap is a
    /// share of the side.
    double estimated_side() const
    {
        const double density = 0.75 * tiles_, share = gap_ / (1 - 2 * border_);
        const double half = share * length_ / (4 * density);
        return half + std::sqrt(half * half + area_ / density);
    }

    /// Tries some layouts, each in tiles of the side predicted by the previous one. More pieces have finer cells; of
    /// very many each gets less time.
    void search(double length, int turns)
    {
        if (packed_.utilization >= enough_) return;
        const std::size_t n = pieces_.size();
        const bool quick = n > 1500;
        const double in_one = static_cast<double>(n) / tiles_;
        const idx fine = quick ? 1024 : std::clamp(static_cast<idx>(90 * std::sqrt(in_one)), 512, 2048);
        const idx cells = trial_ ? fine / 2 : fine;
        draw(cells / length, turns);
        const idx narrowest = side_of_largest();
        idx side = std::max(cells, narrowest);
        tile_layout best;
        double least = std::numeric_limits<double>::infinity();
        for (int k = 0; k < (quick || trial_ ? 3 : n > 200 ? 4 : 6) && !limits_.over(); ++k)
        {
            const double most = 1.02 * side + 1; // has its padding, too, if the layout is a little larger
            tile_layout l = lay_out(pieces_, poses_, halos_, order_, side, tiles_, gap_in_cells(most),
                                    cells_per_length_, quick, limits_);
            ++packed_.layouts;
            if (!l.complete)
            {
                side += side / 4;
                continue;
            }
            const double used = std::max(l.width, l.height), filled = (l.tiles - 1 + l.height / side) / tiles_;
            if (used <= most && used < least)
            {
                least = used;
                best = std::move(l);
            }
            if (side == narrowest || least <= side_of(enough_)) break;
            side = std::max({idx{8}, narrowest, static_cast<idx>(std::lround(side * std::sqrt(filled)))});
        }
        if (!best.complete) return;
        if (effort_ != packing_effort::draft) reorder(best, least, narrowest, trial_ || turns > 16 ? 4 : 1);
        keep(best, least);
    }

    /// The least side of several tiles, in cells, at which each piece fits into one; 0 of a single tile, which is open.
    idx side_of_largest() const
    {
        idx least = 0;
        for (std::size_t c = 0; tiles_ > 1 && c < poses_.size(); ++c)
        {
            idx own = std::numeric_limits<idx>::max();
            for (const pose& p : poses_[c]) own = std::min(own, std::max(p.mask.cells.width, p.mask.cells.height));
            least = std::max(least, own);
        }
        return least;
    }

    /// The side, in cells, that each piece needs by itself: no layout is in a smaller tile.
    double square_of_largest() const
    {
        double most = 0;
        for (const auto& poses : poses_)
        {
            double own = std::numeric_limits<double>::infinity();
            for (const pose& p : poses) own = std::min(own, std::max(p.size.x, p.size.y));
            most = std::max(most, own);
        }
        return most;
    }

    /// The side, in cells, at which tiles are used so much.
    double side_of(double use) const
    {
        return (1 - 2 * border_) * cells_per_length_ * std::sqrt(area_ / (use * tiles_));
    }

    /// Tries other orders near the best one, none twice, in a number of constant total time, or a part of it; of few
    /// pieces other poses of single ones, too, since the pose that lies lowest need not leave the best room to the
    /// others.
    void reorder(tile_layout& best, double& least, idx narrowest, std::size_t part)
    {
        constexpr std::size_t few = 16;
        const std::size_t n = pieces_.size(), tries = std::min<std::size_t>(100, 3000 / n) / part,
                          more = n <= few ? 120 / part : 0;
        std::minstd_rand lot(1);
        double last = least;
        std::vector<idx> only(n, -1);                                        // pose of each piece, -1: any
        std::set<std::tuple<idx, std::vector<idx>, std::vector<idx>>> tried; // by side
        const double bound = std::max(1.002 * square_of_largest(), side_of(enough_));
        for (std::size_t k = 0; n > 1 && k < tries + more && least > bound && !limits_.over(); ++k)
        {
            auto order = order_;
            auto posed = only;
            if (k >= tries && lot() % 2 == 0)
            {
                const std::size_t c = lot() % n;
                posed[c] = static_cast<idx>(lot() % (poses_[c].size() + 1)) - 1;
            }
            else
                for (std::size_t swaps = 1 + lot() % 2; swaps > 0; --swaps)
                {
                    const std::size_t i = lot() % n, j = i + 1 + lot() % std::max<std::size_t>(2, n / 3);
                    if (j < n) std::swap(order[i], order[j]);
                }
            const auto side = static_cast<idx>(least) - 1;
            if (side < narrowest) return;
            if (n <= few && !tried.emplace(side, order, posed).second) continue;
            const double most = std::min(1.002 * last, 1.02 * side + 1);
            tile_rules rules{.only = posed};
            if (tiles_ == 1) rules.top = static_cast<idx>(most) + 1;
            tile_layout l = lay_out(pieces_, poses_, halos_, order, side, tiles_, gap_in_cells(1.02 * side + 1),
                                    cells_per_length_, n > 1500, limits_, {}, rules);
            ++packed_.layouts;
            const double used = std::max(l.width, l.height);
            if (!l.complete || used > most) continue;
            last = used;
            order_ = std::move(order);
            only = std::move(posed);
            if (used >= least) continue;
            least = used;
            best = std::move(l);
        }
    }

    /// Rasterizes all pieces in their poses; large ones are placed first.
    void draw(double cells_per_length, int turns)
    {
        cells_per_length_ = cells_per_length;
        const std::size_t n = pieces_.size();
        doubt_ = 0;
        for (const piece& p : pieces_) doubt_ = std::max(doubt_, p.doubt * cells_per_length_);
        poses_.assign(n, {});
        halos_.reset(n);
        parallel_for(
            n,
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t c = begin; c < end; ++c)
                {
                    const bool alone = turns >= 8 && n == 1 && params_.walls.empty(); // the square is all it needs
                    for (int k = 0; k < turns && !alone; ++k)
                        poses_[c].push_back(make_pose(pieces_[c], 2 * std::numbers::pi * k / turns, cells_per_length_));
                    if (turns >= 8)
                        poses_[c].push_back(make_pose(pieces_[c], squarest_turn(pieces_[c]), cells_per_length_));
                }
            },
            0, 1);
        order_.resize(n);
        std::iota(order_.begin(), order_.end(), idx{0});
        const auto size = [&](idx c)
        {
            const piece& p = pieces_[static_cast<std::size_t>(c)];
            return p.box.x * p.box.y;
        };
        std::stable_sort(order_.begin(), order_.end(), [&](idx a, idx b) { return size(a) > size(b); });
    }

    /// Replaces the layout by one in tiles of this side, if it is better.
    void keep(const tile_layout& l, double side)
    {
        const double cell = (1 - 2 * border_) / side, scale = cell * cells_per_length_;
        if (scale <= packed_.scale) return;
        for (std::size_t c = 0; c < pieces_.size(); ++c)
        {
            const spot& s = l.spots[c];
            const pose& p = poses_[c][static_cast<std::size_t>(s.pose)];
            const vec2 corner(s.x + inset, s.y + inset);
            place(c, p.axis, scale, vec2(border_) + cell * (corner - p.corner), s.tile);
        }
        scaled(scale);
    }

    /// shift: of the piece, whose centre is at 0
    void place(std::size_t c, const vec2& axis, double scale, const vec2& shift, idx tile)
    {
        const piece& p = pieces_[c];
        chart_place at{axis.x, -axis.y, scale * p.density, shift, tile};
        at.shift -= at(p.centre) - at.shift;
        packed_.places[c] = at;
    }

    void scaled(double scale)
    {
        packed_.scale = scale;
        packed_.utilization = area_ * scale * scale / params_.tiles;
    }

    std::span<const piece> pieces_;
    const pack_params& params_;
    packing_effort effort_;
    double enough_;     // use of the tiles
    bool trial_ = true; // on a coarse grid, few layouts
    budget limits_;
    idx tiles_; // that pieces can be in: one needs no second one
    double area_ = 0, length_ = 0;
    double gap_ = 0, border_ = 0; // in tiles
    double cells_per_length_ = 0, doubt_ = 0;
    std::vector<std::vector<pose>> poses_;
    kept_halos halos_;
    std::vector<idx> order_;
    packing packed_;
};

packing pack_outlined(std::span<const vec2> uv, const chart_outlines& outlines, const pack_params& params,
                      const run_limits& limits, packing_effort effort, double enough)
{
    params.validate(outlines.charts());
    limits.validate();
    double area = 0;
    for (const double a : outlines.areas) area += a;
    if (!(area > 0)) throw packing_error(packing_error::no_area, {}, "the charts have no area; flatten them again");
    const auto pieces = make_pieces(uv, outlines, params.densities, params.rotate);
    if (params.on_grid()) return grid_packer(pieces, params, limits).run();
    packing packed = packer(pieces, params, limits, effort, enough).run();
    packed.resolution = params.resolution;
    packed.tiles = params.tiles;
    return packed;
}

} // namespace taut::impl

namespace taut
{

packing pack(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells, std::span<const idx> first_cell,
             std::span<const idx> first_vertex, const pack_params& params, const run_limits& limits)
{
    params.validate(static_cast<idx>(first_cell.size()) - 1);
    limits.validate();
    if (first_cell.size() < 2) return {};
    impl::check_charts(uv, cells, first_cell, first_vertex);
    return impl::pack_outlined(uv, impl::find_outlines(uv, cells, first_cell, first_vertex), params, limits);
}

} // namespace taut
