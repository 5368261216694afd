// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/types.hpp>

/// Lists of varying length in slices of equal width (sliced ELLPACK), made in pieces on several threads: item j of list
/// r is at offsets[r / slice] + j * slice + r % slice.
namespace taut::impl
{

/// Number of rows per thread takes at a time: whole slices, few enough pieces for a scratch array each.
inline std::size_t rows_a_chunk(std::size_t rows)
{
    return std::max<std::size_t>(2048, (rows / 64 + 255) / 256 * 256);
}

/// A piece of lists in slices: their items, and the items of each slice.
struct list_chunk
{
    std::vector<idx> items, sizes;
};

/// The offsets of slices from the sizes in chunks, for `slices` slices; those behind the chunks are empty.
inline std::vector<idx> slice_offsets(const std::vector<list_chunk>& chunks, std::size_t slices)
{
    std::vector<idx> offsets{0};
    offsets.reserve(slices + 1);
    std::size_t end = 0;
    for (const auto& chunk : chunks)
        for (const idx size : chunk.sizes)
        {
            end += static_cast<std::size_t>(size);
            if (end > static_cast<std::size_t>(std::numeric_limits<idx>::max()))
                throw size_error("sliced lists", "more than 2^31 items in a list");
            offsets.push_back(static_cast<idx>(end));
        }
    offsets.resize(slices + 1, static_cast<idx>(end));
    return offsets;
}

/// The items of all chunks, one after the other.
inline std::vector<idx> joined(const std::vector<list_chunk>& chunks)
{
    std::size_t size = 0;
    for (const auto& chunk : chunks) size += chunk.items.size();
    std::vector<idx> all;
    all.reserve(size);
    for (const auto& chunk : chunks) all.insert(all.end(), chunk.items.begin(), chunk.items.end());
    return all;
}

/// Calls body(chunk number, first row, last row + 1) for all chunks of the rows, on all threads.
template <class Body>
void for_each_chunk(std::size_t rows, const Body& body)
{
    const std::size_t size = rows_a_chunk(rows), chunks = (rows + size - 1) / size;
    const auto some = [&](std::size_t begin, std::size_t end)
    {
        for (std::size_t k = begin; k < end; ++k) body(k, k * size, std::min(rows, (k + 1) * size));
    };
    parallel_for(chunks, some, 0, 1);
}
inline std::size_t chunk_count(std::size_t rows)
{
    return (rows + rows_a_chunk(rows) - 1) / rows_a_chunk(rows);
}

} // namespace taut::impl
