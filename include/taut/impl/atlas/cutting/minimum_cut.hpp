// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <taut/impl/atlas/cutting/rest_surface.hpp>

namespace taut::impl
{

/// The sides of least price that part two sets of triangles of a chart: augmenting paths (Edmonds, Karp 1972) in the
/// dual graph. Each edge by its side on the side of `from`. Empty where seams part them already.
inline std::vector<idx> minimum_cut(const rest_surface& rest, std::span<const char> seam, std::span<const idx> from,
                                    std::span<const idx> to)
{
    const auto u = rest_surface::u;
    constexpr idx none = -2, source = -1;
    const std::size_t cells = rest.surface.cells().size();
    std::vector<double> flow(3 * cells, 0);
    const auto room = [&](idx s) { return rest.twin(s) < 0 || seam[u(s)] ? 0.0 : rest.price[u(s)] - flow[u(s)]; };
    const double least = 1e-12 * std::sqrt(rest.total);
    std::vector<char> target(cells, 0);
    for (const idx c : to) target[u(c)] = 1;
    std::vector<idx> came(cells), queue, start;
    for (const idx c : from) came[u(c)] = source;
    for (const idx c : from) // those with neighbours that are not among them
        for (idx s = 3 * c; s < 3 * c + 3; ++s)
            if (rest.twin(s) >= 0 && came[u(rest.twin(s) / 3)] != source && (start.empty() || start.back() != c))
                start.push_back(c);
    for (;;)
    {
        std::fill(came.begin(), came.end(), none);
        queue = start;
        for (const idx c : from) came[u(c)] = source;
        idx end = -1;
        for (std::size_t i = 0; i < queue.size() && end < 0; ++i)
            for (idx s = 3 * queue[i]; s < 3 * queue[i] + 3 && end < 0; ++s)
            {
                if (room(s) <= least) continue;
                const idx c = rest.twin(s) / 3;
                if (came[u(c)] != none) continue;
                came[u(c)] = s;
                queue.push_back(c);
                if (target[u(c)]) end = c;
            }
        if (end < 0) break;
        double most = std::numeric_limits<double>::infinity();
        for (idx c = end; came[u(c)] >= 0; c = came[u(c)] / 3) most = std::min(most, room(came[u(c)]));
        for (idx c = end; came[u(c)] >= 0; c = came[u(c)] / 3)
        {
            flow[u(came[u(c)])] += most;
            flow[u(rest.twin(came[u(c)]))] -= most;
        }
    }
    std::vector<idx> cut;
    for (const idx c : queue)
        for (idx s = 3 * c; s < 3 * c + 3; ++s)
            if (rest.twin(s) >= 0 && !seam[u(s)] && came[u(rest.twin(s) / 3)] == none) cut.push_back(s);
    return cut;
}

} // namespace taut::impl
