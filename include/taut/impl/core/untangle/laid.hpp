// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <taut/impl/core/measure/similarity.hpp>
#include <taut/impl/core/mesh/arrays.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>
#include <taut/impl/core/untangle/target_shapes.hpp>
#include <taut/untangle_problem.hpp>

namespace taut::impl
{

/// Injective map of the surface that ignores fixed coordinates: the surface if it is planar, else a barycentric map.
/// None if the surface has none.
inline std::optional<std::vector<vec2>> unheld_map(const mesh<triangle>& m)
{
    const auto& points = m.points();
    if (is_planar(points))
    {
        std::vector<vec2> x;
        for (const vec3& p : points) x.emplace_back(p.x, p.y);
        return x;
    }
    try
    {
        return barycentric_map(m, {.stretch_rounds = 3}).uv;
    }
    catch (const error&) // closed, not a disk, degenerate: what a surface needs for a map is no matter here
    {
        return std::nullopt;
    }
}

/// Initial guess if there is one, else that map, moved by the similarity that fits pinned vertices to their targets in
/// x (least squares). With fewer than two it gets the expected measure. Fixed coordinates are not set to their targets.
inline std::optional<std::vector<vec2>> laid_start(const untangle_problem<triangle>& problem,
                                                   const std::vector<vec2>& x, const std::vector<vec2>& draft)
{
    if (!draft.empty()) return draft;
    auto laid = unheld_map(problem.rest);
    if (!laid) return std::nullopt;
    std::vector<anchor> anchors;
    for (std::size_t v = 0; v < x.size(); ++v)
        if (problem.held.all(v)) anchors.push_back({(*laid)[v], x[v]});
    similarity map = anchors.empty() ? similarity{.turn = 0} : fit_similarity(anchors).map;
    if (!(std::abs(map.turn) > 0))
    {
        double area = 0;
        for (const auto& t : problem.rest.cells())
        {
            const auto at = [&](std::size_t k) { return (*laid)[static_cast<std::size_t>(t[k])]; };
            area += triangle::measure_factor * triangle::determinant({at(0), at(1), at(2)});
        }
        if (!(area > 0)) return std::nullopt;
        map.turn = std::sqrt(expected_measure(problem, x) / area);
    }
    for (vec2& p : *laid) p = map(p);
    return laid;
}

} // namespace taut::impl
