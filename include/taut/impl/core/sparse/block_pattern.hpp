// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <taut/impl/core/sparse/sliced_lists.hpp>

namespace taut::impl
{

/// The nonzero blocks of a square, structurally symmetric matrix, in slices of equal width (sliced ELLPACK): nonzero j
/// of row r is in column columns[place(r, j)]. The diagonal is nonzero 0, the others are in no special order; places
/// behind the last one of a row name the row itself. Rows are padded to a multiple of 256, and slices of padding alone
/// are 0 wide.
struct block_pattern
{
    idx slice = 16;              ///< rows per slice
    std::size_t count = 0;       ///< rows
    std::vector<idx> offsets{0}; ///< of slices, in places
    std::vector<idx> columns;

    std::size_t rows() const { return count; }
    /// Rows with their padding.
    std::size_t stride() const { return (offsets.size() - 1) * static_cast<std::size_t>(slice); }
    std::size_t place(std::size_t r, std::size_t j) const
    {
        const auto C = static_cast<std::size_t>(slice);
        return static_cast<std::size_t>(offsets[r / C]) + j * C + r % C;
    }
    /// Nonzeros of the longest row of the slice of row r.
    std::size_t width(std::size_t r) const
    {
        const auto s = r / static_cast<std::size_t>(slice);
        return static_cast<std::size_t>((offsets[s + 1] - offsets[s]) / slice);
    }
    idx column(std::size_t r, std::size_t j) const { return columns[place(r, j)]; }
    /// Nonzeros of row r.
    std::size_t length(std::size_t r) const
    {
        std::size_t j = 1;
        while (j < width(r) && column(r, j) != static_cast<idx>(r)) ++j;
        return j;
    }
    /// The number within row r of column c; length(r) if there is none.
    std::size_t find(std::size_t r, idx c) const
    {
        const std::size_t n = length(r);
        std::size_t j = 0;
        while (j < n && column(r, j) != c) ++j;
        return j;
    }
};

/// Up to 16 different numbers >= 0, searched without a branch.
class short_list
{
public:
    static constexpr std::size_t most = 16;

    void clear()
    {
        size_ = 0;
        items_.fill(-1);
    }
    void add(idx c) { items_[size_++] = c; }
    std::size_t size() const { return size_; }
    /// The number of c, or -1.
    int find(idx c) const
    {
        int at = -1;
        for (int k = 0; k < static_cast<int>(most); ++k) at = items_[static_cast<std::size_t>(k)] == c ? k : at;
        return at;
    }

private:
    std::size_t size_ = 0;
    std::array<idx, most> items_{};
};

/// Row of the pattern, to look up its columns.
class sliced_row
{
public:
    void read(const block_pattern& p, std::size_t r)
    {
        const auto C = static_cast<std::size_t>(p.slice);
        const std::size_t first = p.place(r, 0), end = first + p.width(r) * C;
        columns_.clear();
        for (std::size_t at = first; at < end && (at == first || p.columns[at] != p.columns[first]); at += C)
            columns_.push_back(p.columns[at]);
        const std::size_t n = columns_.size();
        sorted_.clear();
        short_.clear();
        if (n <= short_list::most)
        {
            for (const idx c : columns_) short_.add(c);
            return;
        }
        for (std::size_t j = 0; j < n; ++j) sorted_.emplace_back(columns_[j], j);
        std::sort(sorted_.begin(), sorted_.end());
    }

    /// Index of column c among the nonzeros. Throws parameter_error if it is none.
    std::size_t find(idx c) const
    {
        if (const int k = short_.find(c); k >= 0) return static_cast<std::size_t>(k);
        std::size_t j = columns_.size();
        if (const auto at = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(c, std::size_t{0}));
            at != sorted_.end() && at->first == c)
            j = at->second;
        if (j == columns_.size()) throw parameter_error("cells", "couple vertices that the pattern does not");
        return j;
    }

private:
    short_list short_;
    std::vector<idx> columns_;
    std::vector<std::pair<idx, std::size_t>> sorted_;
};

/// A pattern row by row. make_row() is called once a chunk and gives row(r, others), which appends the columns beside
/// the diagonal, each once.
template <class MakeRow>
block_pattern make_pattern(std::size_t rows, idx slice, const MakeRow& make_row)
{
    const auto C = static_cast<std::size_t>(slice);
    std::vector<list_chunk> chunks(chunk_count(rows));
    for_each_chunk(rows,
                   [&](std::size_t k, std::size_t begin, std::size_t end)
                   {
                       auto row = make_row();
                       auto& [items, sizes] = chunks[k];
                       std::vector<idx> others;
                       std::vector<std::size_t> ends(C + 1);
                       sizes.reserve((end - begin) / C + 1);
                       items.reserve(8 * (end - begin));
                       for (std::size_t first = begin; first < end; first += C)
                       {
                           others.clear();
                           std::size_t width = 0;
                           for (std::size_t lane = 0; lane < C; ++lane)
                           {
                               ends[lane] = others.size();
                               if (first + lane >= rows) continue;
                               row(first + lane, others);
                               width = std::max(width, others.size() - ends[lane] + 1);
                           }
                           ends[C] = others.size();
                           const std::size_t base = items.size();
                           items.resize(base + width * C);
                           for (std::size_t lane = 0; lane < C; ++lane)
                           {
                               idx* const at = items.data() + base + lane;
                               at[0] = static_cast<idx>(first + lane);
                               const std::size_t n = ends[lane + 1] - ends[lane];
                               for (std::size_t j = 1; j < width; ++j)
                                   at[j * C] = j <= n ? others[ends[lane] + j - 1] : at[0];
                           }
                           sizes.push_back(static_cast<idx>(width * C));
                       }
                   });
    block_pattern p;
    p.slice = slice;
    p.count = rows;
    p.offsets = slice_offsets(chunks, (std::max<std::size_t>(rows, 1) + 255) / 256 * 256 / C);
    p.columns = joined(chunks);
    return p;
}

} // namespace taut::impl
