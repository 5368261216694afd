// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/core/core/counting_sort.hpp>
#include <taut/impl/core/core/csr.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Convex polygons among the faces of a surface. A reader of a file may triangulate them another way: all triangles of
/// all of these ways are positive in a map where every corner turns left.
struct convex_polygons
{
    std::vector<std::array<idx, 3>> corners; ///< each corner between those before and after it, polygon by polygon
    std::vector<idx> first{0};               ///< offset of the corners of each polygon, and one more
    std::vector<idx> numbers;                ///< numbers of the polygons, as given

    idx size() const { return static_cast<idx>(first.size()) - 1; }
    std::span<const std::array<idx, 3>> corners_of(idx polygon) const
    {
        const auto begin = static_cast<std::size_t>(first[static_cast<std::size_t>(polygon)]);
        const auto end = static_cast<std::size_t>(first[static_cast<std::size_t>(polygon) + 1]);
        return std::span(corners).subspan(begin, end - begin);
    }
};

/// Outline of the triangles of a polygon, valid until the next call on the thread; empty unless it is a polygon without
/// holes.
inline std::span<const idx> outline_of(std::span<const std::array<idx, 3>> cells, std::span<const idx> polygon)
{
    static thread_local std::vector<std::array<idx, 2>> sides, border;
    static thread_local std::vector<idx> loop;
    sides.clear();
    border.clear();
    loop.clear();
    for (const idx c : polygon)
        for (std::size_t k = 0; k < 3; ++k)
            sides.push_back({cells[static_cast<std::size_t>(c)][k], cells[static_cast<std::size_t>(c)][(k + 1) % 3]});
    std::sort(sides.begin(), sides.end());
    for (const auto& [a, b] : sides)
        if (!std::binary_search(sides.begin(), sides.end(), std::array{b, a})) border.push_back({a, b});
    if (border.size() != polygon.size() + 2) return {};
    for (idx v = border.front()[0]; loop.size() < border.size();)
    {
        const auto next = std::lower_bound(border.begin(), border.end(), std::array{v, idx(0)});
        if (next == border.end() || (*next)[0] != v || (next + 1 != border.end() && next[1][0] == v)) return {};
        loop.push_back(v);
        v = (*next)[1];
        if (v == loop.front() && loop.size() < border.size()) return {};
    }
    return loop;
}

/// Returns whether an outline in space is convex in projection along its normal; nearly straight corners do not count
/// as convex.
bool is_convex(std::span<const idx> loop, std::span<const vec3> points);

/// Finds the polygons of more than three corners that are convex in space.
/// cells: triangles; polygon: a number for each, from 0, that of its polygon; points: one per vertex
convex_polygons find_convex_polygons(std::span<const std::array<idx, 3>> cells, std::span<const idx> polygon,
                                     std::span<const vec3> points);

/// Finds the polygons that are not strictly convex in a map, ascending; exact.
std::vector<idx> find_concave(const convex_polygons& polygons, std::span<const vec2> x);

} // namespace taut::impl
