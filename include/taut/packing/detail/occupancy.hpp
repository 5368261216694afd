// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <taut/core/types.hpp>
#include <taut/packing/detail/raster.hpp>

namespace taut::detail
{

/// Calls body(word, mask) for the bits [begin, end) of a row, 64 a word, until it returns false; returns its last
/// answer.
template <class Body>
bool for_each_word(idx begin, idx end, Body&& body)
{
    for (idx x = begin; x < end;)
    {
        const idx low = x % 64, count = std::min<idx>(64 - low, end - x);
        if (!body(static_cast<std::size_t>(x / 64), ~std::uint64_t{0} >> (64 - count) << low)) return false;
        x += count;
    }
    return true;
}

/// Questions to the rows of an occupancy: whether a window of 2^level cells is free, `shift` cells to the right.
struct run_probe
{
    idx row, level, shift;
};

/// A mask to find room for: its runs as probes, those first that are most likely to collide.
struct probe_list
{
    idx width = 0, height = 0;      ///< of the mask, which begins at cell (0, 0)
    idx widest = 0, widest_row = 0; ///< its longest run
    std::vector<run_probe> probes;

    probe_list() = default;

    explicit probe_list(const cell_rows& cells) : height(cells.rows())
    {
        for (idx row = 0; row < height; ++row)
            for (const cell_run& run : cells.row(row))
            {
                width = std::max(width, run.end);
                if (run.end - run.begin <= widest) continue;
                widest = run.end - run.begin;
                widest_row = row;
            }
        probes.reserve(2 * cells.runs.size());
        // Rows far from each other tell more than neighbours do.
        const idx step = stride(height);
        for (idx k = 0, row = widest_row; k < height; ++k, row = (row + step) % height)
            for (const cell_run& run : cells.row(row))
            {
                const idx length = run.end - run.begin, level = std::bit_width(static_cast<unsigned>(length)) - 1;
                probes.push_back({row, level, run.begin});
                if (length != idx{1} << level) probes.push_back({row, level, run.end - (idx{1} << level)});
            }
    }

private:
    /// About 0.38 n and without a common factor.
    static idx stride(idx n)
    {
        const auto common = [](idx a, idx b)
        {
            while (b != 0) a = std::exchange(b, a % b);
            return a;
        };
        idx step = std::max<idx>(1, static_cast<idx>(0.38 * n));
        while (common(step, n) != 1) ++step;
        return step;
    }
};

/// Which cells of a strip are taken. A row is bits, 64 cells a word; its level k has the cells x where one of x, ..., x
/// + 2^k - 1 is taken, so that one word answers for 64 places of a run of any length. What is beyond the strip is
/// taken.
class occupancy
{
public:
    explicit occupancy(idx width)
        : width_(width),
          words_(static_cast<std::size_t>(width) / 64 + 2),
          levels_(static_cast<std::size_t>(std::bit_width(static_cast<unsigned>(width))))
    {
    }

    idx width() const { return width_; }

    /// Takes all of a row: a wall between tiles.
    void block(idx row)
    {
        grow(row + 1);
        for (std::size_t k = 0; k < levels_; ++k) std::fill_n(at(row, k), words_, ~std::uint64_t{0});
        longest_[static_cast<std::size_t>(row)] = 0;
    }

    /// Takes cells, moved by (x, y); what lies outside the strip is left out.
    void take(const cell_rows& cells, idx x, idx y)
    {
        grow(y + cells.low + cells.rows());
        for (idx r = 0; r < cells.rows(); ++r)
        {
            const idx row = y + cells.low + r;
            if (row < 0 || longest_[static_cast<std::size_t>(row)] == 0) continue;
            std::uint64_t* bits = at(row, 0);
            for (const cell_run& run : cells.row(r))
                for_each_word(std::max<idx>(0, run.begin + x), std::min(width_, run.end + x),
                              [bits](std::size_t w, std::uint64_t mask) { return bits[w] |= mask, true; });
            update(row);
        }
    }

    /// The leftmost place in row y for a mask, or -1.
    idx find(const probe_list& mask, idx y)
    {
        grow(y + mask.height);
        if (longest_[static_cast<std::size_t>(y + mask.widest_row)] < mask.widest) return -1;
        const idx places = width_ - mask.width + 1;
        if (places <= 0) return -1;
        const std::size_t n = (static_cast<std::size_t>(places) + 63) / 64;
        std::uint64_t* const taken = scratch_.data();
        std::fill_n(taken, n, std::uint64_t{0});
        if (places % 64 != 0) taken[n - 1] = ~std::uint64_t{0} << (places % 64);
        for (const run_probe& p : mask.probes)
        {
            const std::uint64_t* bits = at(y + p.row, static_cast<std::size_t>(p.level)) + p.shift / 64;
            const unsigned low = static_cast<unsigned>(p.shift) % 64;
            std::uint64_t all = ~std::uint64_t{0};
            if (low == 0)
                for (std::size_t w = 0; w < n; ++w) all &= taken[w] |= bits[w];
            else
                for (std::size_t w = 0; w < n; ++w) all &= taken[w] |= bits[w] >> low | bits[w + 1] << (64 - low);
            if (all == ~std::uint64_t{0}) return -1;
        }
        for (std::size_t w = 0; w < n; ++w)
            if (taken[w] != ~std::uint64_t{0}) return static_cast<idx>(64 * w) + std::countr_one(taken[w]);
        return -1;
    }

private:
    std::uint64_t* at(idx row, std::size_t level)
    {
        return bits_.data() + (static_cast<std::size_t>(row) * levels_ + level) * words_;
    }

    void grow(idx rows)
    {
        const auto old = longest_.size(), wanted = static_cast<std::size_t>(std::max<idx>(rows, 0));
        if (wanted <= old) return;
        longest_.resize(std::max(wanted, 2 * old), width_);
        bits_.resize(longest_.size() * levels_ * words_, 0);
        scratch_.resize(words_);
        for (std::size_t row = old; row < longest_.size(); ++row)
        {
            std::uint64_t* bits = at(static_cast<idx>(row), 0);
            for (std::size_t w = 0; w < words_; ++w) bits[w] = w == words_ - 1 ? ~std::uint64_t{0} : 0;
            if (words_ >= 2) bits[words_ - 2] |= ~std::uint64_t{0} << (width_ % 64);
            update(static_cast<idx>(row));
        }
    }

    /// Levels of a row from its cells, and its longest free run.
    void update(idx row)
    {
        std::size_t top = 0;
        bool some = free_place(at(row, 0));
        for (std::size_t k = 1; k < levels_; ++k)
        {
            const std::uint64_t* below = at(row, k - 1);
            std::uint64_t* bits = at(row, k);
            if (!some)
            {
                std::fill_n(bits, words_, ~std::uint64_t{0});
                continue;
            }
            spread(bits, below, below, std::size_t{1} << (k - 1));
            if (!free_place(bits))
                some = false;
            else
                top = k;
        }
        auto& longest = longest_[static_cast<std::size_t>(row)];
        longest = free_place(at(row, 0)) ? idx{1} << top : 0;
        if (longest == 0) return;
        // Windows of the longest length so far, then of half of that more, and so on.
        std::copy_n(at(row, top), words_, scratch_.data());
        trial_.resize(words_);
        for (std::size_t k = top; k-- > 0;)
        {
            spread(trial_.data(), scratch_.data(), at(row, k), static_cast<std::size_t>(longest));
            if (!free_place(trial_.data())) continue;
            longest += idx{1} << k;
            scratch_.swap(trial_);
        }
    }

    bool free_place(const std::uint64_t* bits) const
    {
        std::uint64_t all = ~std::uint64_t{0};
        for (std::size_t w = 0; w < words_; ++w) all &= bits[w];
        return all != ~std::uint64_t{0};
    }

    /// to(x) = a(x) or b(x + by)
    void spread(std::uint64_t* to, const std::uint64_t* a, const std::uint64_t* b, std::size_t by) const
    {
        const std::size_t skip = by / 64, low = by % 64;
        const auto word = [&](std::size_t w) { return w < words_ ? b[w] : ~std::uint64_t{0}; };
        for (std::size_t w = 0; w < words_; ++w)
        {
            const std::uint64_t first = word(w + skip) >> low;
            to[w] = a[w] | (low == 0 ? first : first | word(w + skip + 1) << (64 - low));
        }
    }

    idx width_;
    std::size_t words_, levels_;
    std::vector<std::uint64_t> bits_, scratch_, trial_;
    std::vector<idx> longest_; // free run of each row
};

} // namespace taut::detail
