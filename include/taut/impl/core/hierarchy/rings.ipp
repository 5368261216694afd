// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <string>

#include <taut/impl/core/hierarchy/rings.hpp>

namespace taut::impl
{

bool order_fan(std::span<spoke_pair> fan, bool& open)
{
    const std::size_t n = fan.size();
    constexpr std::size_t few = 24; // beyond, look-ups by sorting: hubs may have thousands
    std::vector<spoke_pair> by_first, by_second;
    if (n > few)
    {
        by_first.assign(fan.begin(), fan.end());
        std::sort(by_first.begin(), by_first.end());
        for (const auto& [a, b] : fan) by_second.emplace_back(b, a);
        std::sort(by_second.begin(), by_second.end());
    }
    const auto look_up = [](const std::vector<spoke_pair>& sorted, idx key)
    {
        const auto [low, high] = std::equal_range(sorted.begin(), sorted.end(), spoke_pair(key, 0),
                                                  [](const auto& x, const auto& y) { return x.first < y.first; });
        return std::pair(low, high - low);
    };

    // The fan of a boundary vertex starts where no triangle comes before.
    open = false;
    std::size_t start = 0;
    for (std::size_t i = 0; i < n; ++i)
    {
        const bool entered = n > few ? look_up(by_second, fan[i].first).second > 0
                                     : std::any_of(fan.begin(), fan.end(),
                                                   [&](const spoke_pair& s) { return s.second == fan[i].first; });
        if (entered) continue;
        if (open) return false;
        open = true;
        start = i;
    }
    spoke_pair current = fan[start];
    std::swap(fan[0], fan[start]);
    for (std::size_t i = 1; i < n; ++i)
    {
        if (n > few)
        {
            const auto [at, count] = look_up(by_first, current.second);
            if (count != 1 || current.second == fan[0].first) return false;
            fan[i] = *at;
        }
        else
        {
            std::size_t found = 0, where = 0;
            for (std::size_t j = i; j < n; ++j)
                if (fan[j].first == current.second)
                {
                    ++found;
                    where = j;
                }
            if (found != 1) return false;
            std::swap(fan[i], fan[where]);
        }
        current = fan[i];
    }
    return open || current.second == fan[0].first;
}

ring_table make_rings(std::span<const std::array<idx, 3>> cells, std::size_t count, std::vector<char>& open,
                      unsigned threads)
{
    std::vector<spoke_pair> fans(3 * cells.size());
    const auto start = counting_sort(
        fans.size(), count, [&](std::size_t corner) { return cells[corner / 3][corner % 3]; },
        [&](std::size_t corner, std::size_t position)
        {
            const auto& t = cells[corner / 3];
            fans[position] = {t[(corner + 1) % 3], t[(corner + 2) % 3]};
        },
        threads);

    ring_table rings;
    rings.ranges.resize(count);
    rings.items.resize(3 * cells.size() + count); // a boundary vertex has one neighbour more than triangles
    open.assign(count, 0);
    std::atomic<bool> broken{false};
    parallel_for(
        count,
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t v = begin; v < end; ++v)
            {
                const auto first = static_cast<std::size_t>(start[v]), last = static_cast<std::size_t>(start[v + 1]);
                if (first == last) continue;
                const std::span fan(fans.data() + first, last - first);
                bool boundary = false;
                if (!order_fan(fan, boundary))
                {
                    open[v] = -1;
                    broken = true;
                    continue;
                }
                open[v] = boundary;
                idx* out = rings.items.data() + first + v;
                for (const auto& s : fan) *out++ = s.first;
                if (boundary) *out++ = fan.back().second;
                rings.ranges[v] = {static_cast<idx>(first + v), static_cast<idx>(fan.size() + boundary)};
            }
        },
        threads);
    if (broken)
    {
        std::vector<idx> ids;
        for (std::size_t v = 0; v < count; ++v)
            if (open[v] < 0) ids.push_back(static_cast<idx>(v));
        const std::string message =
            "vertex " + std::to_string(ids[0]) +
            ": its triangles do not form one oriented fan; turn or part them, `taut check` and validate() list all";
        throw mesh_error(mesh_error::non_manifold_vertex, std::move(ids), message);
    }
    return rings;
}

} // namespace taut::impl
