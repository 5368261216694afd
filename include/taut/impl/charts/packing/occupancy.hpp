// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <taut/impl/charts/packing/raster.hpp>
#include <taut/types.hpp>

namespace taut::impl
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

/// A mask as probes, those first that are most likely to collide.
struct probe_list
{
    idx width = 0, height = 0;      ///< size of the mask, which begins at cell (0, 0)
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
                const idx length = run.end - run.begin,
                          level = static_cast<idx>(std::bit_width(static_cast<unsigned>(length))) - 1;
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

/// Rows of bits: taken cells, 64 a word. Level k of a row has the cells x where one of x, ..., x + 2^k - 1 is taken, so
/// that one word answers for 64 places of a run of any length. What is beyond the width is taken.
class row_bits
{
public:
    explicit row_bits(idx width)
        : width_(width),
          words_(static_cast<std::size_t>(width) / 64 + 2),
          levels_(static_cast<std::size_t>(std::bit_width(static_cast<unsigned>(width)))),
          scratch_(words_),
          trial_(words_)
    {
    }

    idx width() const { return width_; }
    std::size_t words() const { return words_; }
    idx rows() const { return static_cast<idx>(longest_.size()); }

    /// The cells of a row; update() after a change.
    std::uint64_t* row(idx r) { return at(r, 0); }

    /// Rows up to this one are there, at first free.
    void grow(idx rows)
    {
        const auto old = longest_.size(), wanted = static_cast<std::size_t>(std::max<idx>(rows, 0));
        if (wanted <= old) return;
        longest_.resize(std::max(wanted, 2 * old), width_);
        bits_.resize(longest_.size() * levels_ * words_, 0);
        const auto first = static_cast<idx>(old);
        std::uint64_t* bits = row(first);
        bits[words_ - 2] = ~std::uint64_t{0} << (width_ % 64);
        bits[words_ - 1] = ~std::uint64_t{0};
        update(first);
        for (idx r = first + 1; r < this->rows(); ++r) std::copy_n(at(first, 0), levels_ * words_, at(r, 0));
        std::fill(longest_.begin() + first, longest_.end(), longest_[old]);
    }

    /// Marks in `taken` the places of a mask in row y that are, of those in words [first, last), 64 places each;
    /// returns false if all are. Rows are there.
    bool find(const probe_list& mask, idx y, std::size_t first, std::size_t last,
              std::vector<std::uint64_t>& taken) const
    {
        const idx places = width_ - mask.width + 1;
        if (places <= 0 || longest_[static_cast<std::size_t>(y + mask.widest_row)] < mask.widest) return false;
        last = std::min(last, (static_cast<std::size_t>(places) + 63) / 64);
        if (first >= last) return false;
        taken.assign(last, 0);
        if (last == static_cast<std::size_t>(places) / 64 + 1) taken[last - 1] = ~std::uint64_t{0} << (places % 64);
        std::uint64_t* const to = taken.data();
        for (const run_probe& p : mask.probes)
        {
            const std::uint64_t* bits = at(y + p.row, static_cast<std::size_t>(p.level)) + p.shift / 64;
            const unsigned low = static_cast<unsigned>(p.shift) % 64;
            std::uint64_t all = ~std::uint64_t{0};
            if (low == 0)
                for (std::size_t w = first; w < last; ++w) all &= to[w] |= bits[w];
            else
                for (std::size_t w = first; w < last; ++w) all &= to[w] |= bits[w] >> low | bits[w + 1] << (64 - low);
            if (all == ~std::uint64_t{0}) return false;
        }
        return true;
    }

    /// Levels of a row from its cells, and its longest free run.
    void update(idx r)
    {
        std::size_t top = 0;
        bool some = free_place(at(r, 0));
        idx& longest = longest_[static_cast<std::size_t>(r)];
        longest = some;
        for (std::size_t k = 1; k < levels_; ++k)
        {
            std::uint64_t* bits = at(r, k);
            if (some) spread(bits, at(r, k - 1), at(r, k - 1), std::size_t{1} << (k - 1));
            some = some && free_place(bits);
            if (some)
                top = k;
            else
                std::fill_n(bits, words_, ~std::uint64_t{0});
        }
        if (longest == 0) return;
        // Windows of the longest power of two, then of half of that more, and so on.
        longest <<= top;
        std::copy_n(at(r, top), words_, scratch_.data());
        for (std::size_t k = top; k-- > 0;)
        {
            spread(trial_.data(), scratch_.data(), at(r, k), static_cast<std::size_t>(longest));
            if (!free_place(trial_.data())) continue;
            longest += idx{1} << k;
            scratch_.swap(trial_);
        }
    }

private:
    std::uint64_t* at(idx r, std::size_t level)
    {
        return bits_.data() + (static_cast<std::size_t>(r) * levels_ + level) * words_;
    }
    const std::uint64_t* at(idx r, std::size_t level) const
    {
        return bits_.data() + (static_cast<std::size_t>(r) * levels_ + level) * words_;
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
        const std::size_t skip = by / 64, low = by % 64, inner = words_ > skip ? words_ - skip - 1 : 0;
        if (low == 0)
            for (std::size_t w = 0; w < inner; ++w) to[w] = a[w] | b[w + skip];
        else
            for (std::size_t w = 0; w < inner; ++w) to[w] = a[w] | b[w + skip] >> low | b[w + skip + 1] << (64 - low);
        for (std::size_t w = inner; w < words_; ++w) to[w] = ~std::uint64_t{0};
        if (inner + skip + 1 != words_) return;
        const std::uint64_t last = b[words_ - 1] >> low;
        to[inner] = a[inner] | (low == 0 ? last : last | ~std::uint64_t{0} << (64 - low));
    }

    idx width_;
    std::size_t words_, levels_;
    std::vector<std::uint64_t> bits_, scratch_, trial_;
    std::vector<idx> longest_; // free run of each row
};

/// A mask to find room for, and blocks of 4 x 4 cells that it has a cell of wherever it lies in its own block: row 4 r
/// is always in row r of the blocks.
struct room_mask
{
    probe_list cells, blocks;

    room_mask() = default;

    explicit room_mask(const cell_rows& mask) : cells(mask)
    {
        cell_rows coarse;
        for (idx r = 0; r < mask.rows(); r += 4)
        {
            for (const cell_run& run : mask.row(r))
                if (const idx begin = (run.begin + 3) / 4, end = (run.end - 1) / 4 + 1; begin < end)
                    coarse.runs.push_back({begin, end});
            coarse.first.push_back(static_cast<idx>(coarse.runs.size()));
        }
        blocks = probe_list(coarse);
    }
};

/// Occupied cells of a strip.
class occupancy
{
public:
    explicit occupancy(idx width) : cells_(width), blocks_((width + 3) / 4) {}

    /// Occupies all of a row: a wall between tiles.
    void block(idx row)
    {
        grow(row + 1);
        std::fill_n(cells_.row(row), cells_.words(), ~std::uint64_t{0});
        cells_.update(row);
    }

    /// Occupies cells, moved by (x, y), and ignores those outside the strip.
    void take(const cell_rows& mask, idx x, idx y)
    {
        const idx first = std::max<idx>(0, y + mask.low), last = y + mask.low + mask.rows();
        grow(last + 3);
        for (idx row = first; row < last; ++row)
        {
            std::uint64_t* bits = cells_.row(row);
            for (const cell_run& run : mask.row(row - y - mask.low))
                for_each_word(std::max<idx>(0, run.begin + x), std::min(cells_.width(), run.end + x),
                              [bits](std::size_t w, std::uint64_t m) { return bits[w] |= m, true; });
            cells_.update(row);
        }
        for (idx row = first / 4; 4 * row < last; ++row) fill_blocks(row);
    }

    /// Finds the lowest row from y to `top` where a mask fits, and its leftmost position there: {y, x}; x = -1 if there
    /// is none.
    std::pair<idx, idx> find(const room_mask& mask, idx y, idx top)
    {
        const auto open = [](std::uint64_t w) { return w != ~std::uint64_t{0}; };
        while (y <= top)
        {
            const idx end = std::min(y | 3, top);
            grow(end + mask.cells.height);
            std::size_t first = 0, last = cells_.words();
            if (!mask.blocks.probes.empty()) // they say the same for four rows
            {
                if (!blocks_.find(mask.blocks, y / 4, 0, blocks_.words(), taken_))
                {
                    y = end + 1;
                    continue;
                }
                first = 4 * static_cast<std::size_t>(std::find_if(taken_.begin(), taken_.end(), open) - taken_.begin());
                last = 4 * static_cast<std::size_t>(taken_.rend() - std::find_if(taken_.rbegin(), taken_.rend(), open));
            }
            for (; y <= end; ++y)
                if (cells_.find(mask.cells, y, first, last, taken_))
                {
                    const auto word =
                        std::find_if(taken_.begin() + static_cast<std::ptrdiff_t>(first), taken_.end(), open);
                    return {y, static_cast<idx>(64 * (word - taken_.begin())) + std::countr_one(*word)};
                }
        }
        return {y, -1};
    }

private:
    void grow(idx rows)
    {
        cells_.grow(rows);
        blocks_.grow(rows / 4 + 1);
    }

    void fill_blocks(idx row)
    {
        std::uint64_t* to = blocks_.row(row);
        for (std::size_t w = 0; w < cells_.words(); ++w)
        {
            std::uint64_t all = ~std::uint64_t{0};
            for (idx k = 0; k < 4; ++k) all &= cells_.row(4 * row + k)[w];
            all &= all >> 1;
            all &= all >> 2;
            // Every fourth bit, to the low end.
            all &= 0x1111111111111111U;
            all = (all | all >> 3) & 0x0303030303030303U;
            all = (all | all >> 6) & 0x000f000f000f000fU;
            all = (all | all >> 12) & 0x000000ff000000ffU;
            all = (all | all >> 24) & 0xffffU;
            to[w / 4] |= all << (16 * (w % 4));
        }
        blocks_.update(row);
    }

    row_bits cells_, blocks_;          // blocks: of which all cells are taken
    std::vector<std::uint64_t> taken_; // places, of the last question
};

} // namespace taut::impl
