// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include <taut/certify.hpp>
#include <taut/impl/charts/packing/chart_overlaps.hpp>
#include <taut/impl/charts/packing/outlines.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/pack.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

inline double distance(const vec2& p, const vec2& a, const vec2& b)
{
    const vec2 d = b - a;
    const double square = glm::dot(d, d), t = square > 0 ? std::clamp(glm::dot(p - a, d) / square, 0.0, 1.0) : 0;
    return glm::length(a + t * d - p);
}

/// Distance of two segments.
inline double distance(const vec2& a, const vec2& b, const vec2& c, const vec2& d)
{
    if (segments_meet(a, b, c, d)) return 0;
    return std::min({distance(a, c, d), distance(b, c, d), distance(c, a, b), distance(d, a, b)});
}

/// Certifies a packing of charts with known borders in these coordinates.
inline packing_certificate certify_outlined(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells,
                                            const chart_outlines& outlines, std::span<const char> pinned,
                                            double aspect = 1)
{
    const auto at = [uv](idx v) { return uv[static_cast<std::size_t>(v)]; };
    const auto is_pinned = [pinned](idx c) { return !pinned.empty() && pinned[static_cast<std::size_t>(c)] != 0; };
    packing_certificate sealed;
    overlap_search search(uv, cells, outlines, 100'000);
    const auto chart = search.chart_of_edge();
    const edge_tree tree(outlines.edges, uv, outlines.first);
    const auto find_gap = [&]
    {
        tree.for_each_pair_within(sealed.gap,
                                  [&](std::size_t i, std::size_t j)
                                  {
                                      if (is_pinned(chart[i]) && is_pinned(chart[j])) return true;
                                      const auto &e = outlines.edges[i], &f = outlines.edges[j];
                                      const double d = distance(at(e[0]), at(e[1]), at(f[0]), at(f[1]));
                                      if (d >= sealed.gap) return true;
                                      sealed.gap = d;
                                      sealed.nearest = {std::min(chart[i], chart[j]), std::max(chart[i], chart[j])};
                                      return d > 0;
                                  });
    };
    const auto find_border = [&]
    {
        for (std::size_t c = 0; c + 1 < outlines.first.size(); ++c)
        {
            if (is_pinned(static_cast<idx>(c))) continue;
            vec2 low(std::numeric_limits<double>::infinity()), high = -low;
            for (idx e = outlines.first[c]; e < outlines.first[c + 1]; ++e)
                for (const idx v : outlines.edges[static_cast<std::size_t>(e)])
                {
                    low = glm::min(low, at(v));
                    high = glm::max(high, at(v));
                }
            const vec2 sides(1, aspect), tile = sides * glm::floor((low / 2.0 + high / 2.0) / sides);
            const vec2 inside = glm::min(low - tile, tile + sides - high);
            if (std::min(inside.x, inside.y) >= sealed.border) continue;
            sealed.border = std::min(inside.x, inside.y);
            sealed.outermost = static_cast<idx>(c);
        }
    };
    parallel_for(
        3,
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t task = begin; task < end; ++task)
                if (task == 0)
                    find_gap();
                else if (task == 1)
                    search.nested(tree);
                else
                    find_border();
        },
        0, 1);
    // Borders that meet have no distance.
    if (!(sealed.gap > 0) || !pinned.empty()) search.crossing(tree);
    sealed.overlaps = search.found();
    return sealed;
}

} // namespace taut::impl
