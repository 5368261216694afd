// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <taut/compute/quirks.hpp>
#include <taut/compute/range.hpp>
#include <taut/core/error.hpp>
#include <taut/core/types.hpp>

namespace taut
{

/// How rows are dealt to the lanes of a device: `slice` rows lie together, an item does `lanes` of them (1 or 16).
struct lane_form
{
    index slice = 16;
    index lanes = 16;

    /// Explicit vectors of 16 on CPUs, a row an item and a slice a warp on GPUs.
    static lane_form for_device(const device& d)
    {
        return quirks::wants_serial_items(d) ? lane_form{16, 16} : lane_form{32, 1};
    }

    /// The items of so many rows (a multiple of the slice), padded to whole groups.
    range items(std::size_t rows) const
    {
        const std::size_t group = lanes == 1 ? 128 : 16;
        return {padded(rows / static_cast<std::size_t>(lanes), group), group};
    }
};

/// Lists of varying length in slices of equal width (sliced ELLPACK): item j of list r is at
/// offsets[r / slice] + j * slice + r % slice.
struct sliced_lists
{
    index slice = 16;
    std::vector<index> offsets{0}; ///< slices + 1

    /// Room for `rows` lists; length(r) is needed for the first `lists`, the others are empty.
    template <class Length>
    sliced_lists(std::size_t lists, std::size_t rows, index slice_rows, const Length& length) : slice(slice_rows)
    {
        const auto C = static_cast<std::size_t>(slice);
        offsets.reserve(rows / C + 1);
        std::size_t end = 0;
        for (std::size_t first = 0; first < rows; first += C)
        {
            std::size_t width = 0;
            for (std::size_t r = first; r < std::min(first + C, lists); ++r)
                width = std::max(width, static_cast<std::size_t>(length(r)));
            end += width * C;
            if (end > static_cast<std::size_t>(std::numeric_limits<index>::max()))
                throw parameter_error("sliced_lists", "more than 2^31 items");
            offsets.push_back(static_cast<index>(end));
        }
    }

    std::size_t size() const { return static_cast<std::size_t>(offsets.back()); }
    std::size_t place(std::size_t row, std::size_t j) const
    {
        const auto C = static_cast<std::size_t>(slice);
        return static_cast<std::size_t>(offsets[row / C]) + j * C + row % C;
    }
};

} // namespace taut
