// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/certify.hpp>
#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_border.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/exact/crossings.hpp>

namespace taut::impl
{

/// Returns whether the image of a simple loop is counter-clockwise; exact.
inline bool turns_left(std::span<const idx> loop, std::span<const vec2> uv)
{
    const auto at = [&](std::size_t k) { return uv[static_cast<std::size_t>(loop[k % loop.size()])]; };
    std::size_t first = 0; // leftmost, then lowest: a convex corner
    for (std::size_t k = 1; k < loop.size(); ++k)
        if (at(k).x < at(first).x || (at(k).x == at(first).x && at(k).y < at(first).y)) first = k;
    return orient2d(at(first + loop.size() - 1), at(first), at(first + 1)) > 0;
}

/// Returns whether the borders of a chart show that its map, free of flips, overlaps. The number of times that a point
/// is covered is the sum of the winding numbers of the borders: at most once if they are simple, apart from each other,
/// and all but one run around holes.
inline bool overlaps_itself(std::span<const std::vector<idx>> loops, std::span<const vec2> uv)
{
    const auto left = [&](const std::vector<idx>& loop) { return turns_left(loop, uv); };
    return !for_each_meeting(edges_of(loops), uv, [](std::size_t, std::size_t) { return false; }) ||
           std::count_if(loops.begin(), loops.end(), left) != 1;
}

/// Returns whether chart k has so many triangles that it can overlap itself without flips: two lie on either side of
/// their edge.
inline bool may_overlap(const chart_mesh& charts, std::size_t k)
{
    return charts.first_cell[k + 1] - charts.first_cell[k] > 2;
}

/// Returns whether a chart, without flips, of genus 0, overlaps itself.
/// uv: one per vertex of charts.surface, finite
inline bool overlaps_itself(const chart_mesh& charts, std::size_t k, std::span<const vec2> uv)
{
    if (!may_overlap(charts, k)) return false;
    static thread_local std::vector<std::array<idx, 2>> border;
    border.clear();
    for_each_border_side(charts, static_cast<idx>(k), [&](idx from, idx to) { border.push_back({from, to}); });
    // By Euler, V - E + F = 2 - loops.
    const idx vertices = charts.first_vertex[k + 1] - charts.first_vertex[k];
    const idx cells = charts.first_cell[k + 1] - charts.first_cell[k];
    const bool disk = 2 * vertices - (3 * cells + static_cast<idx>(border.size())) + 2 * cells == 2;
    // A single border that does not meet itself has the chart to its left.
    if (disk) return !for_each_meeting(border, uv, [](std::size_t, std::size_t) { return false; });
    return overlaps_itself(border_loops(charts, static_cast<idx>(k)), uv);
}

/// One flag per chart, of such charts: 1 where it overlaps itself.
inline std::vector<char> crossing_charts(const chart_mesh& charts, std::span<const vec2> uv)
{
    std::vector<char> crossing(static_cast<std::size_t>(charts.charts()), 0);
    parallel_for(
        crossing.size(),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t k = begin; k < end; ++k) crossing[k] = overlaps_itself(charts, k, uv);
        },
        0, 8);
    return crossing;
}

} // namespace taut::impl
