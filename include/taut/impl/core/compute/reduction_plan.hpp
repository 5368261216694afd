// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>

#include <taut/impl/core/compute/quirks.hpp>

namespace taut::impl
{

/// Partition of a reduction of n elements into blocks, one per work-group. It depends on n and on the form alone, so a
/// sum is the same bit for bit on any number of cores; not with any driver, whose compiler may fuse multiply and add.
struct reduction_plan
{
    std::size_t local = 1;          ///< items per group: 1 (serial form) or a power of two, at least 4 (group form)
    std::size_t width = 8;          ///< elements a load: 8 (serial form) or 1 (group form)
    std::size_t least_block = 4096; ///< a block has at least this many elements where n allows
    std::size_t most_groups = 64;   ///< and there are at most this many blocks

    /// For CPUs: each item runs serially through one long block with 8-wide accumulators.
    static constexpr reduction_plan serial() { return {1, 8, 4096, 64}; }
    /// For GPUs: neighbouring items take neighbouring elements; one barrier joins the 256 items of a group.
    static constexpr reduction_plan grouped() { return {256, 1, 512, 1024}; }

    static reduction_plan for_device(const device& d)
    {
        reduction_plan plan = quirks::wants_serial_items(d) ? serial() : grouped();
        while (plan.local > d.max_group()) plan.local /= 2;
        return plan;
    }

    struct blocks
    {
        std::size_t length; ///< elements per block, a multiple of the width
        std::size_t count;  ///< at least 1, also for n = 0
    };

    constexpr blocks cut(std::size_t n) const
    {
        const std::size_t groups = std::clamp<std::size_t>((n + least_block - 1) / least_block, 1, most_groups);
        const std::size_t unit = std::max(local, 4 * width);
        const std::size_t length = std::max((n + groups - 1) / groups, std::size_t{1});
        const std::size_t rounded = (length + unit - 1) / unit * unit;
        return {rounded, std::max((n + rounded - 1) / rounded, std::size_t{1})};
    }
};

} // namespace taut::impl
