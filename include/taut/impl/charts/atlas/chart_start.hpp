// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <taut/charts.hpp>
#include <taut/impl/charts/atlas/chart_mesh.hpp>
#include <taut/impl/charts/atlas/unfolded.hpp>
#include <taut/impl/core/exact/convex_polygons.hpp>
#include <taut/impl/core/start/barycentric_map.hpp>

namespace taut::impl
{

/// A chart as a mesh of its own, times a power of two that brings its extent near 1. Vertices and triangles keep their
/// order.
struct single_chart
{
    mesh<triangle> surface;
    double unit; ///< lengths here by those of the chart mesh

    static single_chart of(const chart_mesh& charts, idx k)
    {
        const mesh<triangle> alone = chart_alone(charts, static_cast<std::size_t>(k));
        std::vector<vec3> points = alone.points();
        const vec3 origin = points.front();
        double extent = 0;
        for (vec3& p : points)
        {
            p -= origin;
            extent = std::max({extent, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        }
        const double unit = extent > 0 ? std::ldexp(1.0, std::clamp(-std::ilogb(extent), -1000, 1000)) : 1.0;
        for (vec3& p : points) p *= unit;
        return {mesh<triangle>(std::move(points), alone.cells()), unit};
    }
};

/// Points projected along the mean normal; none where that is 0.
inline std::vector<vec2> projected(const mesh<triangle>& m)
{
    vec3 normal(0.0);
    for (idx c = 0; c < m.cell_count(); ++c)
    {
        const auto x = m.rest(c);
        normal += glm::cross(x[1] - x[0], x[2] - x[0]);
    }
    std::vector<vec2> uv;
    if (!(glm::length(normal) > 0)) return uv;
    normal = glm::normalize(normal);
    const vec3 other = std::abs(normal.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    const vec3 across = glm::normalize(glm::cross(normal, other)), up = glm::cross(normal, across);
    uv.reserve(m.points().size());
    for (const vec3& p : m.points()) uv.emplace_back(glm::dot(p, across), glm::dot(p, up));
    return uv;
}

/// Initial map of a chart.
struct chart_start
{
    std::vector<vec2> uv;
    double energy = std::numeric_limits<double>::infinity(); ///< area mean

    /// Replaces the map by another one if that is valid and better.
    void consider(const mesh<triangle>& m, const ideal_elements<triangle>& ideal, std::vector<vec2> other)
    {
        if (other.empty()) return;
        start_map map;
        map.uv = std::move(other);
        assess(map, m, ideal);
        if (!map.flips || !(map.distortion.measure < energy)) return;
        energy = map.distortion.measure;
        uv = std::move(map.uv);
    }

    static constexpr double good = 6; ///< energy that Newton's method lowers in a few steps

    /// Considers the chart unfolded, and a barycentric map where that is folded or strongly distorted.
    /// Without any map, throws mesh_error where the chart is closed or has handles.
    void consider_laid(const mesh<triangle>& m, const ideal_elements<triangle>& ideal)
    {
        const auto f = facets(m);
        consider(m, ideal, unfolded(m, f));
        if (energy < good) return;
        try
        {
            validate(m, f, {.referenced = false, .one_boundary = false});
            consider(m, ideal, barycentric_map(m, f, {.stretch_rounds = 1}).uv);
        }
        catch (const error&)
        {
            if (uv.empty()) throw;
        }
    }

    /// Computes the initial map: the given one, if it is valid; else the chart projected along its mean normal, or
    /// laid otherwise where that is folded or strongly distorted. given: one point per vertex, or empty; in units of
    /// the chart.
    /// Throws mesh_error where the chart is closed or has handles, `error` where no map without flips was found.
    static chart_start of(const mesh<triangle>& m, const ideal_elements<triangle>& ideal, std::vector<vec2> given)
    {
        chart_start start;
        start.consider(m, ideal, std::move(given));
        if (!start.uv.empty()) return start;
        start.consider(m, ideal, projected(m));
        if (!(start.energy < good)) start.consider_laid(m, ideal);
        if (start.uv.empty()) throw error("no map without flipped triangles was found to begin with");
        return start;
    }
};

/// Maps a chart of a single polygon to a circle, corner after corner by the lengths of its edges: whatever its shape in
/// space, all its triangles are then positive and disjoint. A polygon with holes is not changed.
inline void lay_round(const chart_mesh& charts, std::size_t k, std::span<vec2> uv)
{
    std::vector<idx> cells(static_cast<std::size_t>(charts.first_cell[k + 1] - charts.first_cell[k]));
    std::iota(cells.begin(), cells.end(), charts.first_cell[k]);
    const auto loop = outline_of(charts.surface.cells(), cells);
    std::vector<double> way{0};
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
        const auto at = [&](std::size_t j)
        { return charts.surface.points()[static_cast<std::size_t>(loop[j % loop.size()])]; };
        way.push_back(way.back() + glm::distance(at(i), at(i + 1)));
    }
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
        const double angle = 2 * std::numbers::pi * way[i] / way.back(), radius = way.back() / (2 * std::numbers::pi);
        uv[static_cast<std::size_t>(loop[i])] = radius * vec2(std::cos(angle), std::sin(angle));
    }
}

} // namespace taut::impl
