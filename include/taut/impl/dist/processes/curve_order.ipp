// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/dist/processes/curve_order.hpp>

#include <limits>
#include <span>

#include <taut/impl/core/mesh/order.hpp>

namespace taut::dist::impl
{

/// Vertices with keys of the Morton curve in the bounding cube of those of all processes.
std::vector<keyed_vertex> keyed(const communicator& all, const std::vector<named_vertex>& vertices)
{
    vec3 low(std::numeric_limits<double>::max()), high = -low;
    for (const auto& v : vertices) low = glm::min(low, v.x), high = glm::max(high, v.x);
    double extent = 0; // halves, because the extent of finite points may overflow
    for (int k = 0; k < 3; ++k)
    {
        low[k] = all.least(low[k]);
        high[k] = all.most(high[k]);
        extent = std::max(extent, 0.5 * high[k] - 0.5 * low[k]);
    }
    std::vector<keyed_vertex> result;
    result.reserve(vertices.size());
    for (const auto& v : vertices)
    {
        const vec3 unit = extent > 0 ? (0.5 * v.x - 0.5 * low) / extent : vec3(0.0);
        result.push_back({taut::impl::morton(2097151.0 * unit), v.id, v.x});
    }
    return result;
}

/// Keys that cut all into parts of equal size, as far as equal keys allow, size() + 1 of them: each is made bit by bit,
/// by how many keys lie below.
inline std::vector<std::uint64_t> splitters(const communicator& all, const std::vector<keyed_vertex>& vertices,
                                            std::int64_t total)
{
    std::vector<std::uint64_t> keys;
    keys.reserve(vertices.size());
    for (const auto& v : vertices) keys.push_back(v.key);
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint64_t> split(all.ranks() + 1, 0);
    split.back() = std::numeric_limits<std::uint64_t>::max();
    std::vector<std::int64_t> below(all.ranks());
    for (int bit = 62; bit >= 0; --bit)
    {
        const std::uint64_t one = std::uint64_t{1} << bit;
        for (std::size_t r = 1; r < all.ranks(); ++r)
            below[r] = std::lower_bound(keys.begin(), keys.end(), split[r] | one) - keys.begin();
        all.add(std::span(below));
        for (std::size_t r = 1; r < all.ranks(); ++r)
            if (below[r] <= total * static_cast<std::int64_t>(r) / all.size()) split[r] |= one;
        std::fill(below.begin(), below.end(), 0);
    }
    return split;
}

void tell_homes(const communicator& all, homes& at_home, const std::vector<keyed_vertex>& vertices, std::int64_t number)
{
    struct numbered
    {
        std::int64_t id, number;
    };
    parcels<numbered> names(all.ranks());
    for (const auto& v : vertices) names[at_home.home(v.id)].push_back({v.id, number++});
    for (const auto& n : all.exchange(names).items)
        at_home.number(static_cast<std::size_t>(at_home.place(n.id))) = n.number;
}

std::vector<keyed_vertex> in_curve_order(const communicator& all, homes& at_home, const number_ranges& ranges)
{
    auto mine = keyed(all, at_home.known());
    const std::int64_t total = ranges.bounds.back();
    const auto split = splitters(all, mine, total);
    parcels<keyed_vertex> to(all.ranks());
    for (const auto& v : mine)
        to[static_cast<std::size_t>(std::upper_bound(split.begin() + 1, split.end() - 1, v.key) - split.begin()) - 1]
            .push_back(v);
    mine = {};
    auto sorted = all.exchange(to).items;
    std::sort(sorted.begin(), sorted.end());
    std::int64_t number = all.before(static_cast<std::int64_t>(sorted.size()));
    tell_homes(all, at_home, sorted, number);
    for (auto& parcel : to) parcel.clear();
    for (const auto& v : sorted) to[ranges.owner(number++)].push_back(v);
    sorted = {};
    auto owned = all.exchange(to).items;
    std::sort(owned.begin(), owned.end());
    return owned;
}

} // namespace taut::dist::impl
