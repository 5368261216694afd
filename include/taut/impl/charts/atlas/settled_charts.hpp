// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/charts/atlas/crossing_charts.hpp>
#include <taut/impl/charts/packing/settle_map.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/exact/convex_polygons.hpp>

namespace taut::impl
{

/// The triangle of a chart that is flipped, -1 if none is; exact.
inline idx turned_triangle(const chart_mesh& charts, std::size_t k, std::span<const vec2> uv)
{
    const auto at = [uv](idx v) { return uv[static_cast<std::size_t>(v)]; };
    for (idx c = charts.first_cell[k]; c < charts.first_cell[k + 1]; ++c)
        if (const auto& t = charts.surface.cells()[static_cast<std::size_t>(c)];
            orient2d(at(t[0]), at(t[1]), at(t[2])) <= 0)
            return c;
    return -1;
}

/// Returns whether a chart of many triangles is much smaller than the units of the file's numbers allow: it is to be
/// scaled up, and no time is spent on it before.
inline bool is_hopeless(std::span<const vec2> x, idx triangles, const settling& how)
{
    constexpr idx few = 64;
    if (how.stored == nullptr || triangles < few) return false;
    const auto [low, high] = box_about(x);
    return glm::length(high - low) < 16 * std::sqrt(static_cast<double>(triangles)) * spacing_at(high, how.stored);
}

/// Rounds charts to the precision of a file so that each is valid, if its vertices need not leave their reach.
/// polygons: to be convex; uv: positions, one per vertex of the charts, then the rounded ones
/// Returns one flag per chart: 1 where triangles are still flipped, or the border meets itself.
inline std::vector<char> settle_charts(const chart_mesh& charts, const convex_polygons& polygons, std::span<vec2> uv,
                                       const settling& how)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    const auto& cells = charts.surface.cells();
    std::vector<char> bad(u(charts.charts()), 0);
    parallel_for(
        bad.size(),
        [&](std::size_t begin, std::size_t end)
        {
            std::vector<vec2> exact;
            for (std::size_t k = begin; k < end; ++k)
            {
                const idx low = charts.first_vertex[k], high = charts.first_vertex[k + 1];
                const auto own = uv.subspan(u(low), u(high - low));
                exact.assign(own.begin(), own.end());
                if (how.stored != nullptr) std::transform(own.begin(), own.end(), own.begin(), how.stored);
                const auto before = [](const std::array<idx, 3>& corner, idx v) { return corner[0] < v; };
                const auto first = std::lower_bound(polygons.corners.begin(), polygons.corners.end(), low, before);
                const std::span corners(first, std::lower_bound(first, polygons.corners.end(), high, before));
                const auto is_bad = [&]
                { return turned_triangle(charts, k, uv) >= 0 || overlaps_itself(charts, k, uv); };
                const bool concave =
                    std::any_of(corners.begin(), corners.end(),
                                [&](const auto& c) { return orient2d(uv[u(c[0])], uv[u(c[1])], uv[u(c[2])]) <= 0; });
                bad[k] = is_bad();
                if (!bad[k] && !concave) continue;
                if (bad[k] && how.held.empty() &&
                    is_hopeless(own, charts.first_cell[k + 1] - charts.first_cell[k], how))
                    continue;
                std::copy(exact.begin(), exact.end(), own.begin());
                const std::span some(cells.data() + charts.first_cell[k], cells.data() + charts.first_cell[k + 1]);
                settle_piece(some, corners, low, high, uv, how);
                bad[k] = is_bad();
            }
        },
        0, 8);
    return bad;
}

} // namespace taut::impl
