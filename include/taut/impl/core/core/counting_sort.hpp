// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <taut/impl/core/core/parallel.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Stable counting sort of 0 .. n-1 on several threads: calls place(i, position) for each i, with positions by
/// bucket(i) in [0, buckets), then by i. Returns where each bucket starts, and n last. `place` is called from several
/// threads, never twice for a position. threads: maximum number; 0: as many as the machine runs at once.
template <class Bucket, class Place>
std::vector<idx> counting_sort(std::size_t n, std::size_t buckets, Bucket bucket, Place place, unsigned threads = 0)
{
    // Each part of the range counts for itself; more parts would cost more memory than they gain time.
    const std::size_t parts = std::clamp<std::size_t>(n / 32768, 1, threads > 0 ? std::min(threads, 4U) : 4U);
    const auto for_each_part = [&](const auto& body)
    {
        parallel_for(
            parts,
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t p = begin; p < end; ++p) body(p, n * p / parts, n * (p + 1) / parts);
            },
            threads, 1);
    };

    std::vector<std::vector<idx>> next(parts);
    for_each_part(
        [&](std::size_t p, std::size_t begin, std::size_t end)
        {
            auto& count = next[p];
            count.assign(buckets, 0);
            for (std::size_t i = begin; i < end; ++i) ++count[static_cast<std::size_t>(bucket(i))];
        });
    std::vector<idx> start(buckets + 1);
    idx total = 0;
    for (std::size_t b = 0; b < buckets; ++b)
    {
        start[b] = total;
        for (auto& count : next)
        {
            const idx here = count[b];
            count[b] = total;
            total += here;
        }
    }
    start[buckets] = total;
    for_each_part(
        [&](std::size_t p, std::size_t begin, std::size_t end)
        {
            auto& position = next[p];
            for (std::size_t i = begin; i < end; ++i)
                place(i, static_cast<std::size_t>(position[static_cast<std::size_t>(bucket(i))]++));
        });
    return start;
}

} // namespace taut::impl
