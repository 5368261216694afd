// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <mutex>
#include <vector>

#include <taut/impl/charts/paste/surface/surface_tree.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/exact/triangles_meet.hpp>
#include <taut/mesh.hpp>

namespace taut::impl
{

/// Pairs of triangles that meet elsewhere than in the corner or the edge that they share, the smaller number first, in
/// order; exact. O(n log n + pairs of boxes that meet), on all threads.
inline std::vector<std::array<idx, 2>> self_intersections(const mesh<triangle>& m)
{
    std::vector<std::array<idx, 2>> pairs;
    const impl::surface_tree tree(m.points(), m.cells());
    std::mutex mine;
    impl::parallel_for(
        m.cells().size(),
        [&](std::size_t begin, std::size_t end)
        {
            std::vector<std::array<idx, 2>> found;
            for (std::size_t k = begin; k < end; ++k)
            {
                const auto f = static_cast<idx>(k);
                const auto x = m.rest(f);
                const vec3 low = glm::min(x[0], glm::min(x[1], x[2])), high = glm::max(x[0], glm::max(x[1], x[2]));
                tree.for_each_near(low, high,
                                   [&](idx g)
                                   {
                                       const auto& other = m.cells()[static_cast<std::size_t>(g)];
                                       if (f < g && impl::triangles_meet(m.points(), m.cells()[k], other))
                                           found.push_back({f, g});
                                   });
            }
            const std::lock_guard lock(mine);
            pairs.insert(pairs.end(), found.begin(), found.end());
        });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

} // namespace taut::impl
