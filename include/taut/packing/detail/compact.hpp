// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <taut/core/budget.hpp>
#include <taut/core/parallel.hpp>
#include <taut/packing/detail/layout.hpp>

namespace taut::detail
{

/// The pieces of one tile on a fine grid, where they slide one by one.
class sliding_pieces
{
public:
    struct piece_masks
    {
        cell_rows body, halo;
        idx x, y;
    };

    sliding_pieces(std::vector<piece_masks> masks, idx width, idx height)
        : masks_(std::move(masks)),
          words_(static_cast<std::size_t>(width) / 64 + 1),
          width_(width),
          height_(height),
          columns_(width / bin + 1),
          bits_(words_ * static_cast<std::size_t>(height)),
          bins_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(height / bin + 1))
    {
        for (const auto& m : masks_)
        {
            idx left = width, right = 0;
            for (const cell_run& run : m.halo.runs)
            {
                left = std::min(left, run.begin);
                right = std::max(right, run.end);
            }
            sides_.push_back({left, right});
        }
        for (std::size_t i = 0; i < masks_.size(); ++i)
        {
            draw(i, true);
            for_each_bin(i, [i](std::vector<std::size_t>& b) { b.push_back(i); });
        }
    }

    /// Slides a piece down and left until it is stuck; returns whether it moved.
    bool settle(std::size_t i)
    {
        piece_masks& m = masks_[i];
        const idx x = m.x, y = m.y;
        neighbours_.clear();
        for_each_bin(i,
                     [&](std::vector<std::size_t>& b)
                     {
                         neighbours_.insert(neighbours_.end(), b.begin(), b.end());
                         std::erase(b, i);
                     });
        std::sort(neighbours_.begin(), neighbours_.end());
        neighbours_.erase(std::unique(neighbours_.begin(), neighbours_.end()), neighbours_.end());
        draw(i, false);
        for (const std::size_t k : neighbours_)
            if (k != i) draw(k, true);
        for (bool moved = true; moved;)
        {
            moved = false;
            for (; free(m, m.x, m.y - 1); --m.y) moved = true;
            for (; free(m, m.x - 1, m.y); --m.x) moved = true;
        }
        draw(i, true);
        for_each_bin(i, [i](std::vector<std::size_t>& b) { b.push_back(i); });
        return m.x != x || m.y != y;
    }

    const std::vector<piece_masks>& masks() const { return masks_; }

private:
    static constexpr idx bin = 128;

    template <class Body>
    void for_each_bin(std::size_t i, Body&& body)
    {
        const piece_masks& m = masks_[i];
        const auto clamped = [](idx a, idx n) { return std::clamp<idx>(a, 0, n - 1) / bin; };
        const idx bottom = m.y + m.halo.low, top = bottom + m.halo.rows();
        for (idx r = clamped(bottom, height_); r <= clamped(top, height_); ++r)
            for (idx c = clamped(m.x + sides_[i].begin, width_); c <= clamped(m.x + sides_[i].end, width_); ++c)
                body(bins_[static_cast<std::size_t>(r * columns_ + c)]);
    }

    void draw(std::size_t i, bool set)
    {
        const piece_masks& m = masks_[i];
        for (idx r = 0; r < m.halo.rows(); ++r)
        {
            const idx row = m.y + m.halo.low + r;
            if (row < 0 || row >= height_) continue;
            std::uint64_t* bits = bits_.data() + static_cast<std::size_t>(row) * words_;
            for (const cell_run& run : m.halo.row(r))
                for_each_word(std::max<idx>(0, m.x + run.begin), std::min(width_, m.x + run.end),
                              [&](std::size_t w, std::uint64_t mask)
                              { return bits[w] = set ? bits[w] | mask : bits[w] & ~mask, true; });
        }
    }

    bool free(const piece_masks& m, idx x, idx y) const
    {
        if (x < 0 || y < 0) return false;
        for (idx r = 0; r < m.body.rows(); ++r)
        {
            const std::uint64_t* bits = bits_.data() + static_cast<std::size_t>(y + r) * words_;
            for (const cell_run& run : m.body.row(r))
                if (!for_each_word(x + run.begin, x + run.end,
                                   [bits](std::size_t w, std::uint64_t mask) { return (bits[w] & mask) == 0; }))
                    return false;
        }
        return true;
    }

    std::vector<piece_masks> masks_;
    std::size_t words_;
    idx width_, height_, columns_;
    std::vector<std::uint64_t> bits_;
    std::vector<std::vector<std::size_t>> bins_;
    std::vector<cell_run> sides_; // of the halos
    std::vector<std::size_t> neighbours_;
};

/// Slides the pieces of a layout down and left on a grid that is `finer` times as fine: what rounding to cells left
/// between them goes. Cells of what is returned are those of the finer grid.
/// gap: in cells of the finer grid
inline layout compact(std::span<const piece> pieces, std::span<const std::vector<pose>> poses, layout coarse, idx finer,
                      double gap, double cells_per_length, budget& limits)
{
    layout fine = std::move(coarse);
    const idx side = finer * (static_cast<idx>(std::max(fine.width, fine.height)) + 2);
    for (idx tile = 0; tile < fine.tiles; ++tile)
    {
        std::vector<std::size_t> members;
        for (std::size_t c = 0; c < pieces.size(); ++c)
            if (fine.spots[c].tile == tile) members.push_back(c);
        std::vector<sliding_pieces::piece_masks> masks(members.size());
        parallel_for(
            members.size(),
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t i = begin; i < end; ++i)
                {
                    const std::size_t c = members[i];
                    const spot& s = fine.spots[c];
                    pose at = poses[c][static_cast<std::size_t>(s.pose)];
                    at.corner *= finer;
                    const auto edges = posed_edges(pieces[c], at, finer * cells_per_length);
                    masks[i] = {rasterize(edges, 0), rasterize(edges, gap), finer * s.x, finer * s.y};
                }
            },
            0, 1);
        sliding_pieces sliding(std::move(masks), side, side);
        std::vector<std::size_t> order(members.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        bool moved = true;
        for (int sweep = 0; sweep < 8 && moved && limits.proceed(); ++sweep)
        {
            std::stable_sort(order.begin(), order.end(),
                             [&](std::size_t a, std::size_t b)
                             {
                                 const auto &m = sliding.masks()[a], &n = sliding.masks()[b];
                                 return std::pair(m.y, m.x) < std::pair(n.y, n.x);
                             });
            moved = false;
            for (const std::size_t i : order) moved = sliding.settle(i) || moved;
        }
        for (std::size_t i = 0; i < members.size(); ++i)
        {
            fine.spots[members[i]].x = sliding.masks()[i].x;
            fine.spots[members[i]].y = sliding.masks()[i].y;
        }
    }
    fine.measure(poses, finer);
    return fine;
}

} // namespace taut::detail
