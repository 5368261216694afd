// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <taut/impl/core/core/parallel.hpp>

namespace taut::impl
{

/// A sum over [0, n) on several threads, with a rounding that does not depend on their number: add(part, i) puts i into
/// a part; there is one per block, begun as Part{}, and parts are added by += in their order.
template <class Part, class Add>
Part block_sum(std::size_t n, const Add& add, unsigned threads = 0)
{
    constexpr std::size_t block = 2048;
    std::vector<Part> parts((n + block - 1) / block);
    parallel_for(
        parts.size(),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t b = begin; b < end; ++b)
            {
                Part part{}; // not in place: neighbours in memory would share cache lines between threads
                for (std::size_t i = b * block; i < std::min(n, (b + 1) * block); ++i) add(part, i);
                parts[b] = part;
            }
        },
        threads, 2);
    Part whole{};
    for (const Part& part : parts) whole += part;
    return whole;
}

} // namespace taut::impl
