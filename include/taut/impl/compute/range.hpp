// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <taut/impl/core/padded.hpp>

namespace taut
{

/// Launch range: the number of work-items, and of those in one work-group. local = 0 lets the queue choose: 64 on a CPU
/// and 128 on a GPU where that divides global, else the driver's choice, which is slow for odd sizes. Pad buffers and
/// ranges instead.
struct range
{
    std::size_t global = 0;
    std::size_t local = 0;

    constexpr range(std::size_t all) : global(all) {} // NOLINT: k(n, ...) reads as it should
    constexpr range(std::size_t all, std::size_t group) : global(all), local(group) {}
};

} // namespace taut
