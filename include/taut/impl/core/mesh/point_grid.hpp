// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Grid of points for nearest neighbour search.
class point_grid
{
public:
    /// reach: maximum search distance
    point_grid(std::span<const vec3> points, double reach) : points_(points), reach_(reach), near_(points.size())
    {
        start_ = counting_sort(
            points.size(), std::max<std::size_t>(points.size(), 1),
            [&](std::size_t i) { return bucket(cell(points[i])); },
            [&](std::size_t i, std::size_t at) { near_[at] = static_cast<idx>(i); });
    }

    /// The nearest point within reach, or -1.
    idx nearest(const vec3& x) const
    {
        const auto low = cell(x - reach_), high = cell(x + reach_);
        idx best = -1;
        double least = reach_;
        for (auto i = low[0]; i <= high[0]; ++i)
            for (auto j = low[1]; j <= high[1]; ++j)
                for (auto k = low[2]; k <= high[2]; ++k)
                {
                    const std::size_t b = bucket({i, j, k});
                    for (auto at = static_cast<std::size_t>(start_[b]); at < static_cast<std::size_t>(start_[b + 1]);
                         ++at)
                    {
                        const double d = glm::distance(points_[static_cast<std::size_t>(near_[at])], x);
                        if (d > least || (d == least && best >= 0)) continue;
                        least = d;
                        best = near_[at];
                    }
                }
        return best;
    }

private:
    using place = std::array<std::int64_t, 3>;

    place cell(const vec3& x) const
    {
        const vec3 c = glm::floor(x / (4 * reach_));
        return {static_cast<std::int64_t>(c.x), static_cast<std::int64_t>(c.y), static_cast<std::int64_t>(c.z)};
    }

    std::size_t bucket(const place& at) const
    {
        std::uint64_t h = 0;
        for (const std::int64_t i : at) h = (h ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15U, h ^= h >> 32U;
        return h % points_.size();
    }

    std::span<const vec3> points_;
    double reach_;
    std::vector<idx> start_, near_; // of buckets, and what is in them
};

} // namespace taut::impl
