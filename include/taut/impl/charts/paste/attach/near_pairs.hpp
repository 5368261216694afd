// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <taut/types.hpp>

namespace taut::impl
{

/// Calls pair(i, j, distance), i < j, for the points within `reach` of each other, by boxes of that size. Of points
/// within the unit box.
template <class Pair>
void for_each_near_pair(std::span<const vec3> points, double reach, const Pair& pair)
{
    using box = std::array<std::int64_t, 3>;
    std::map<box, std::vector<std::size_t>> boxes;
    for (std::size_t j = 0; j < points.size(); ++j)
    {
        box at;
        for (std::size_t k = 0; k < 3; ++k)
            at[k] = static_cast<std::int64_t>(std::floor(points[j][static_cast<int>(k)] / reach));
        for (std::int64_t x = -1; x <= 1; ++x)
            for (std::int64_t y = -1; y <= 1; ++y)
                for (std::int64_t z = -1; z <= 1; ++z)
                {
                    const auto found = boxes.find({at[0] + x, at[1] + y, at[2] + z});
                    if (found == boxes.end()) continue;
                    for (const std::size_t i : found->second)
                        if (const double r = glm::distance(points[i], points[j]); r <= reach) pair(i, j, r);
                }
        boxes[at].push_back(j);
    }
}

} // namespace taut::impl
