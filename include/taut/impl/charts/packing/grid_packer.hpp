// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/charts/packing/layout.hpp>
#include <taut/impl/charts/packing/pieces.hpp>
#include <taut/impl/core/core/budget.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/core/short_number.hpp>
#include <taut/pack.hpp>

namespace taut::impl
{

/// Packs pieces on a grid of cells whose size does not follow from the layout: blocks of texels, or cells of tiles that
/// are not squares. The scale is given, or the largest that is found by bisection, to one part in a hundred.
class grid_packer
{
public:
    grid_packer(std::span<const piece> pieces, const pack_params& params, const run_limits& limits)
        : pieces_(pieces), params_(params), limits_(limits.time_limit, limits.observer), resolution_(params.resolution)
    {
        for (const piece& p : pieces_) area_ += p.area;
        order_.resize(pieces_.size());
        std::iota(order_.begin(), order_.end(), idx{0});
        const auto size = [&](idx c)
        { return pieces_[static_cast<std::size_t>(c)].box.x * pieces_[static_cast<std::size_t>(c)].box.y; };
        std::stable_sort(order_.begin(), order_.end(), [&](idx a, idx b) { return size(a) > size(b); });
        packed_.places.resize(pieces_.size());
    }

    packing run()
    {
        if (params_.texels_per_unit > 0)
            at_given_scale();
        else
            at_largest_scale();
        packed_.complete = packed_.complete && !limits_.over();
        packed_.resolution = resolution_;
        return std::move(packed_);
    }

private:
    /// The grid of a tile: its cells, and where the first one begins.
    struct grid
    {
        double cell = 0; ///< side in widths of a tile
        vec2 corner{0, 0};
        idx columns = 0, rows = 0;
    };

    /// tiles: of which all are on the device of one occupancy
    grid grid_for(idx tiles) const
    {
        // Two points may come nearer by the rounding of both, and a place is off by its own.
        const double padding = params_.padding / resolution_;
        const double border = padding + params_.rounding + 1e-12;
        grid g;
        if (params_.align > 1)
        {
            int block = params_.align;
            while (resolution_ / block > 4096) block *= 2;
            g.cell = static_cast<double>(block) / resolution_;
            const double margin = std::ceil(border / g.cell);
            g.corner = vec2(margin * g.cell);
            g.columns = static_cast<idx>(std::floor(1 / g.cell - 2 * margin + 1e-9));
            g.rows = static_cast<idx>(std::floor(params_.aspect / g.cell - 2 * margin + 1e-9));
            return g;
        }
        const double n = static_cast<double>(pieces_.size()) / tiles;
        g.columns = std::clamp(static_cast<idx>(90 * std::sqrt(n / std::min(1.0, params_.aspect))), 512, 2048);
        g.cell = (1 - 2 * border) / g.columns;
        g.corner = vec2(border);
        g.rows = static_cast<idx>(std::floor((params_.aspect - 2 * border) / g.cell));
        return g;
    }

    double gap(const grid& g) const
    {
        return (params_.padding / resolution_ + 2 * std::numbers::sqrt2 * params_.rounding + 1e-12) / g.cell;
    }

    /// Rasterizes all pieces in their poses.
    void draw(double cells_per_length)
    {
        const int turns = !params_.rotate ? 1 : pieces_.size() <= 200 ? 8 : 4;
        poses_.assign(pieces_.size(), {});
        halos_.reset(pieces_.size());
        parallel_for(
            pieces_.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t c = begin; c < end; ++c)
                    for (int k = 0; k < turns; ++k)
                        poses_[c].push_back(make_pose(pieces_[c], 2 * std::numbers::pi * k / turns, cells_per_length));
            },
            0, 1);
    }

    std::vector<taken_cells> walls_in(const grid& g) const
    {
        std::vector<std::vector<std::array<vec2, 2>>> edges(static_cast<std::size_t>(params_.tiles));
        for (const tile_wall& wall : params_.walls)
            edges[static_cast<std::size_t>(wall.tile)].push_back(
                {(wall.edge[0] - g.corner) / g.cell, (wall.edge[1] - g.corner) / g.cell});
        std::vector<taken_cells> taken;
        for (std::size_t tile = 0; tile < edges.size(); ++tile)
            if (!edges[tile].empty()) taken.push_back({static_cast<idx>(tile), rasterize(edges[tile], gap(g))});
        return taken;
    }

    /// A layout at this scale in some tiles; keeps it if there is one. required: whatever the limits say
    bool lay(double scale, idx tiles, bool required)
    {
        const grid g = grid_for(tiles);
        if (g.columns < 1 || g.rows < 1) return false;
        const double cells_per_length = scale / g.cell;
        for (const piece& p : pieces_) // before anything is drawn
            if (cells_per_length * std::max(p.box.x, p.box.y) > std::hypot(g.columns, g.rows)) return false;
        draw(cells_per_length);
        double doubt = 0;
        for (const piece& p : pieces_) doubt = std::max(doubt, p.doubt * cells_per_length);
        budget unlimited(budget::unlimited, {});
        const bool quick = pieces_.size() > 1500 && params_.groups.empty();
        const auto walls = walls_in(g);
        const tile_layout l =
            lay_out(pieces_, poses_, halos_, order_, g.columns, tiles, gap(g) + doubt, cells_per_length, quick,
                    required ? unlimited : limits_, walls, {.rows = g.rows, .groups = params_.groups});
        ++packed_.layouts;
        if (!l.complete) return false;
        for (std::size_t c = 0; c < pieces_.size(); ++c)
        {
            const spot& s = l.spots[c];
            const pose& p = poses_[c][static_cast<std::size_t>(s.pose)];
            const vec2 shift = g.corner + g.cell * (vec2(s.x + inset, s.y + inset) - p.corner);
            chart_place at{p.axis.x, -p.axis.y, scale * pieces_[c].density, shift, s.tile};
            at.shift -= at(pieces_[c].centre) - at.shift;
            packed_.places[c] = at;
        }
        packed_.scale = scale;
        packed_.tiles = params_.texels_per_unit > 0 ? l.tiles : params_.tiles;
        packed_.utilization = area_ * scale * scale / (packed_.tiles * params_.aspect);
        return true;
    }

    void at_given_scale()
    {
        for (;; resolution_ *= 2)
        {
            const double scale = params_.texels_per_unit / resolution_;
            const double filled = area_ * scale * scale / params_.aspect; // tiles
            if (filled <= params_.tiles)
                for (idx tiles = std::min(params_.tiles, static_cast<idx>(1.3 * filled) + 1);; tiles *= 2)
                {
                    tiles = params_.groups.empty() && params_.walls.empty() ? std::min(params_.tiles, tiles)
                                                                            : params_.tiles;
                    if (lay(scale, tiles, true)) return;
                    if (tiles == params_.tiles) break;
                }
            if (2 * resolution_ > params_.max_resolution) break;
        }
        throw packing_error(
            packing_error::no_room, {},
            "at " + short_number(params_.texels_per_unit) + " texels a unit the charts, of which " + largest_box() +
                ", do not fit into " + std::to_string(params_.tiles) +
                (params_.tiles == 1 ? " tile of " : " tiles of ") + std::to_string(resolution_) + " x " +
                short_number(resolution_ * params_.aspect) +
                " texels; ask for fewer texels, or for more or larger tiles; a triangle, a polygon or a kept "
                "chart larger than a tile needs fewer texels or a higher resolution");
    }

    /// "the largest is 300 x 20", in texels.
    std::string largest_box() const
    {
        vec2 box(0.0);
        for (const piece& p : pieces_)
            if (std::max(p.box.x, p.box.y) > std::max(box.x, box.y)) box = p.box;
        return "the largest is " + short_number(std::ceil(params_.texels_per_unit * box.x)) + " x " +
               short_number(std::ceil(params_.texels_per_unit * box.y));
    }

    void at_largest_scale()
    {
        const double full = std::sqrt(params_.tiles * params_.aspect / area_);
        double high = full, low = 0, scale = 0.8 * full;
        while (low == 0 && scale > 1e-4 * full) // the first that fits
        {
            if (lay(scale, params_.tiles, true))
                low = scale;
            else
            {
                high = scale;
                scale *= 0.8;
            }
        }
        if (low == 0)
            throw packing_error(packing_error::no_room, {},
                                "the padding around " + std::to_string(pieces_.size()) + " charts takes all of " +
                                    std::to_string(params_.tiles) + (params_.tiles == 1 ? " tile" : " tiles") +
                                    "; ask for less padding, a higher resolution or more tiles");
        while (high > 1.01 * low && !limits_.over())
        {
            scale = std::sqrt(low * high);
            (lay(scale, params_.tiles, false) ? low : high) = scale;
        }
    }

    std::span<const piece> pieces_;
    const pack_params& params_;
    budget limits_;
    int resolution_;
    double area_ = 0;
    std::vector<idx> order_;
    std::vector<std::vector<pose>> poses_;
    kept_halos halos_;
    packing packed_;
};

} // namespace taut::impl
