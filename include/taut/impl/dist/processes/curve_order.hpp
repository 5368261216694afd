// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <taut/impl/dist/processes/communicator.hpp>
#include <taut/impl/dist/processes/homes.hpp>
#include <taut/types.hpp>

namespace taut::dist::impl
{

/// A vertex with its place on the Morton curve of all.
struct keyed_vertex
{
    std::uint64_t key;
    std::int64_t id;
    vec3 x;

    friend bool operator<(const keyed_vertex& a, const keyed_vertex& b)
    {
        return a.key != b.key ? a.key < b.key : a.id < b.id;
    }
};

/// Contiguous ranges of numbers, one a process.
struct number_ranges
{
    std::vector<std::int64_t> bounds; ///< process r has [bounds[r], bounds[r + 1])

    number_ranges() = default;
    number_ranges(std::int64_t total, int processes)
    {
        for (std::int64_t r = 0; r <= processes; ++r)
            bounds.push_back(total / processes * r + total % processes * r / processes);
    }
    explicit number_ranges(const std::vector<std::int64_t>& sizes) : bounds{0}
    {
        for (const std::int64_t size : sizes) bounds.push_back(bounds.back() + size);
    }
    std::size_t owner(std::int64_t number) const
    {
        return static_cast<std::size_t>(std::upper_bound(bounds.begin(), bounds.end(), number) - bounds.begin()) - 1;
    }
};

/// Tells the homes of vertices that their numbers follow each other, from `number` on.
void tell_homes(const communicator& all, homes& at_home, const std::vector<keyed_vertex>& vertices,
                std::int64_t number);

/// The vertices of a range of the curve, in its order; all of them have numbers by their places on it, which are
/// written to their homes.
std::vector<keyed_vertex> in_curve_order(const communicator& all, homes& at_home, const number_ranges& ranges);

} // namespace taut::dist::impl
