// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <taut/impl/core/compute/quirks.hpp>
#include <taut/impl/core/core/padded.hpp>
#include <taut/queue.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Distribution of rows over the lanes of a device: `slice` rows lie together, an item does `lanes` of them (1 or 16).
struct lane_form
{
    idx slice = 16;
    idx lanes = 16;

    /// The most coarse rows that an item on a CPU sums together in a product P' A P, for K weights per row of P.
    static constexpr std::size_t product_rows(std::size_t K) { return K > 3 ? 32 : 64; }

    /// Explicit vectors of 16 on CPUs, a row an item and a slice a warp on GPUs.
    static lane_form for_device(const device& d)
    {
        return quirks::wants_serial_items(d) ? lane_form{16, 16} : lane_form{32, 1};
    }

    /// Items on a GPU that sum a row together, of such a product and of a dense one.
    static constexpr idx share = 16;

    /// Items that invert a dense matrix together.
    constexpr idx team() const { return lanes == 1 ? 256 : 1; }

    /// The items of so many rows (a multiple of the slice), padded to whole groups.
    range items(std::size_t rows) const
    {
        const auto group = static_cast<std::size_t>(this->group());
        return {padded(rows / static_cast<std::size_t>(lanes), group), group};
    }
    constexpr idx group() const { return lanes == 1 ? 128 : 16; }

    /// The same with `share` items a row on GPUs.
    range shared_items(std::size_t rows) const
    {
        return items(rows * static_cast<std::size_t>(lanes == 1 ? share : 1));
    }
};

} // namespace taut::impl
