// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <taut/core/budget.hpp>
#include <taut/core/parallel.hpp>
#include <taut/packing/detail/compact.hpp>
#include <taut/packing/detail/layout.hpp>
#include <taut/packing/detail/outlines.hpp>
#include <taut/packing/detail/pieces.hpp>
#include <taut/packing/detail/shelves.hpp>
#include <taut/packing/pack.hpp>

namespace taut
{

namespace detail
{

/// One run of the packer: layouts are tried one after the other, and the one with the largest scale is kept.
class packer
{
public:
    packer(std::span<const piece> pieces, const pack_params& params)
        : pieces_(pieces), params_(params), limits_(params.time_limit, params.observer)
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
        const auto n = pieces_.size();
        const idx grid = std::clamp(static_cast<idx>(40 * std::sqrt(static_cast<double>(n))), idx{256}, idx{1024});
        draw(grid);
        const bool quick = n > 1000;
        const int layouts = n > 1000 ? 3 : n > 200 ? 4 : 6;
        auto side = grid;
        layout best;
        double best_side = 0;
        for (int k = 0; k < layouts && !limits_.over(); ++k)
        {
            // Room for the padding of a side that turns out a little larger.
            layout l = lay_out(pieces_, poses_, order_, side, params_.tiles, gap_in_cells(1.02 * side + 1),
                               cells_per_length_, quick, limits_);
            ++packed_.layouts;
            const double used = std::max(l.width, l.height), full = params_.tiles == l.tiles ? used : l.width;
            if (!l.complete)
            {
                side += side / 4;
                continue;
            }
            if (full <= 1.02 * side + 1 && (best_side == 0 || used < best_side))
            {
                best_side = used;
                best = l;
            }
            const double filled = (l.tiles - 1 + std::min(1.0, 1.0 * l.height / side)) / params_.tiles;
            const double over = l.height > side ? (l.tiles - 1 + l.height / side) / params_.tiles : filled;
            side = std::max<idx>(8, static_cast<idx>(std::lround(side * std::sqrt(over))));
        }
        if (best_side > 0)
        {
            const idx finer = 4;
            const layout fine =
                compact(pieces_, poses_, best, finer, finer * gap_in_cells(best_side), cells_per_length_, limits_);
            keep(fine, finer);
        }
        packed_.complete = !limits_.over();
        return std::move(packed_);
    }

private:
    double gap_in_cells(double side) const { return gap_ * side / (1 - 2 * border_) + doubt_; }

    void on_shelves()
    {
        const auto shelves = lay_on_shelves(pieces_, params_.tiles, border_, gap_);
        for (std::size_t c = 0; c < pieces_.size(); ++c)
        {
            const vec2 low = box_in(pieces_[c].hull, pieces_[c].axis)[0];
            place(c, pieces_[c].axis, shelves.scale, shelves.corners[c] - shelves.scale * low, shelves.tiles[c]);
        }
        scaled(shelves.scale);
    }

    /// Draws all pieces in their poses, for tiles of about so many cells.
    void draw(idx grid)
    {
        // side^2 = (area + gaps around) / density, where the gaps are a share of the side.
        const double density = 0.75 * params_.tiles, share = gap_ / (1 - 2 * border_);
        const double half = share * length_ / (4 * density);
        double side = half + std::sqrt(half * half + area_ / density);
        for (const piece& p : pieces_) side = std::max(side, p.box.y);
        cells_per_length_ = grid / side;
        const auto u = pieces_.size();
        poses_.resize(u);
        doubt_ = 0;
        for (const piece& p : pieces_) doubt_ = std::max(doubt_, p.doubt * cells_per_length_);
        const int turns = !params_.rotate ? 1 : u <= 1000 ? 8 : 4;
        parallel_for(
            u,
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t c = begin; c < end; ++c)
                {
                    poses_[c].clear();
                    for (int k = 0; k < turns; ++k)
                        poses_[c].push_back(make_pose(pieces_[c], 2 * std::numbers::pi * k / turns, cells_per_length_));
                }
            },
            0, 1);
        order_.resize(u);
        std::iota(order_.begin(), order_.end(), idx{0});
        const auto size = [&](idx c)
        {
            const piece& p = pieces_[static_cast<std::size_t>(c)];
            return p.box.x * p.box.y;
        };
        std::stable_sort(order_.begin(), order_.end(), [&](idx a, idx b) { return size(a) > size(b); });
    }

    void keep(const layout& l, idx finer)
    {
        const double side = l.tiles > 1 ? std::max(l.width, l.height) : std::max(l.width, l.height);
        const double cell = (1 - 2 * border_) / side, scale = cell * finer * cells_per_length_;
        if (scale <= packed_.scale) return;
        for (std::size_t c = 0; c < pieces_.size(); ++c)
        {
            const spot& s = l.spots[c];
            const pose& p = poses_[c][static_cast<std::size_t>(s.pose)];
            const vec2 corner(s.x + inset, s.y + inset);
            place(c, p.axis, scale, vec2(border_) + cell * (corner - static_cast<double>(finer) * p.corner), s.tile);
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
    budget limits_;
    double area_ = 0, length_ = 0;
    double gap_ = 0, border_ = 0; // in tiles
    double cells_per_length_ = 0, doubt_ = 0;
    std::vector<std::vector<pose>> poses_;
    std::vector<idx> order_;
    packing packed_;
};

} // namespace detail

TAUT_INLINE packing pack(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells,
                         std::span<const idx> first_cell, std::span<const idx> first_vertex, const pack_params& params)
{
    params.validate(static_cast<idx>(first_cell.size()) - 1);
    if (first_cell.size() < 2) return {};
    detail::check_charts(uv, cells, first_cell, first_vertex);
    const auto outlines = detail::find_outlines(uv, cells, first_cell, first_vertex);
    double area = 0;
    for (const double a : outlines.areas) area += a;
    if (!(area > 0)) throw packing_error(packing_fault::no_area, {}, "the charts have no area; flatten them again");
    const auto pieces = detail::make_pieces(uv, outlines, params.densities, params.rotate);
    return detail::packer(pieces, params).run();
}

} // namespace taut
