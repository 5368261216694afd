// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <taut/bake.hpp>
#include <taut/impl/core/core/parallel.hpp>

namespace taut::impl
{

/// The row of the nearest known texel in the column of each texel; -1 where a column has none.
inline std::vector<idx> nearest_in_column(std::span<const std::uint8_t> known, idx width, idx height)
{
    std::vector<idx> row(known.size(), -1);
    const auto w = static_cast<std::size_t>(width);
    parallel_for(
        w,
        [&](std::size_t begin, std::size_t end)
        {
            idx j = 0;
            for (std::size_t at = 0; at < known.size(); at += w, ++j) // the last one below
                for (std::size_t i = begin; i < end; ++i)
                    row[at + i] = known[at + i] != 0 ? j : j > 0 ? row[at + i - w] : -1;
            for (j = height - 2; j >= 0; --j)
            {
                const std::size_t at = static_cast<std::size_t>(j) * w;
                for (std::size_t i = begin; i < end; ++i)
                    if (const idx above = row[at + w + i];
                        above > j && (row[at + i] < 0 || above - j < j - row[at + i]))
                        row[at + i] = above;
            }
        },
        0, 64);
    return row;
}

/// Columns of a row with what they know: where the nearest known texel of each place of the row is, by the lower
/// envelope of parabolas (Felzenszwalb, Huttenlocher 2012), in whole numbers.
class row_envelope
{
public:
    /// The column with the nearest known texel for each place of row j; -1 if there is none at all.
    void nearest(std::span<const idx> rows, idx j, std::span<idx> column)
    {
        columns_.clear();
        starts_.clear();
        for (idx i = 0; i < static_cast<idx>(rows.size()); ++i)
        {
            if (rows[static_cast<std::size_t>(i)] < 0) continue;
            const std::int64_t h = height(rows, i, j);
            std::int64_t start = 0;
            while (!columns_.empty())
            {
                const idx last = columns_.back();
                const std::int64_t g = height(rows, last, j), d = i - last;
                // (x - i)^2 + h < (x - last)^2 + g from here on
                const std::int64_t sum = h - g + std::int64_t(i) * i - std::int64_t(last) * last;
                start = floor_of(sum, 2 * d) + 1;
                if (start > starts_.back()) break;
                columns_.pop_back();
                starts_.pop_back();
            }
            columns_.push_back(i);
            starts_.push_back(columns_.size() == 1 ? 0 : start);
        }
        std::size_t at = 0;
        for (std::size_t x = 0; x < column.size(); ++x)
        {
            while (at + 1 < columns_.size() && starts_[at + 1] <= static_cast<std::int64_t>(x)) ++at;
            column[x] = columns_.empty() ? -1 : columns_[at];
        }
    }

private:
    static std::int64_t height(std::span<const idx> rows, idx i, idx j)
    {
        const std::int64_t d = rows[static_cast<std::size_t>(i)] - j;
        return d * d;
    }
    static std::int64_t floor_of(std::int64_t a, std::int64_t b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

    std::vector<idx> columns_;
    std::vector<std::int64_t> starts_; // from which place on each is the nearest
};

/// Gives texels that are not known the value of the nearest known one, if that is at most `gutter` texels away, centre
/// to centre.
inline void fill_gutters(texture& image, std::span<const std::uint8_t> known, double gutter)
{
    if (!(gutter > 0)) return;
    const auto w = static_cast<std::size_t>(image.width), c = static_cast<std::size_t>(image.channels);
    const std::vector<idx> rows = nearest_in_column(known, image.width, image.height);
    const float* const from = image.texels.data(); // known ones, which stay
    parallel_for(
        static_cast<std::size_t>(image.height),
        [&](std::size_t begin, std::size_t end)
        {
            row_envelope envelope;
            std::vector<idx> column(w);
            for (std::size_t j = begin; j < end; ++j)
            {
                const auto row = std::span<const idx>(rows).subspan(j * w, w);
                envelope.nearest(row, static_cast<idx>(j), column);
                for (std::size_t i = 0; i < w; ++i)
                {
                    if (column[i] < 0 || known[j * w + i] != 0) continue;
                    const auto x = static_cast<std::size_t>(column[i]), y = static_cast<std::size_t>(row[x]);
                    const double dx = static_cast<double>(x) - static_cast<double>(i),
                                 dy = static_cast<double>(y) - static_cast<double>(j);
                    if (dx * dx + dy * dy > gutter * gutter) continue;
                    std::copy_n(&from[(y * w + x) * c], c, &image.texels[(j * w + i) * c]);
                }
            }
        },
        0, 64);
}

} // namespace taut::impl
