// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/atlas/cutting/flat_surface.hpp>
#include <taut/impl/core/counting_sort.hpp>
#include <taut/impl/exact/crossings.hpp>

namespace taut::impl
{

/// Pairs of border edges of the same chart whose images meet, counted up to `most`; exact.
inline std::size_t border_crossings(const rest_surface& rest, const flat_surface& flat, std::size_t most)
{
    const auto u = rest_surface::u;
    std::vector<vec2> place(flat.fan_cells.size(), vec2(0.0));
    std::vector<idx> border;
    for (std::size_t s = 0; s < flat.seam.size(); ++s)
    {
        place[u(flat.fan[s])] = flat.uv[s];
        if (rest.facets.twin[s] < 0 || flat.seam[s]) border.push_back(static_cast<idx>(s));
    }
    const auto [chart, charts] = pieces_between(rest.facets, flat.seam);
    std::vector<std::array<idx, 2>> edges(border.size());
    const auto first = counting_sort(
        border.size(), u(charts), [&, &chart = chart](std::size_t i) { return chart[u(border[i] / 3)]; },
        [&](std::size_t i, std::size_t at)
        {
            edges[at] = {flat.fan[u(rest_surface::start_corner(border[i]))],
                         flat.fan[u(rest_surface::end_corner(border[i]))]};
        });
    std::size_t count = 0;
    for (std::size_t k = 0; k + 1 < first.size() && count < most; ++k)
        for_each_meeting(std::span(edges).subspan(u(first[k]), u(first[k + 1] - first[k])), place,
                         [&](std::size_t, std::size_t) { return ++count < most; });
    return count;
}

} // namespace taut::impl
