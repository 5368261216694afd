// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include <support/meshes.hpp>

/// Generated strips in space, long and thin, whose maps of least distortion mostly cross themselves.
namespace taut::test
{

/// The quads (i, j) of an nx by ny grid for which has(i, j), with the vertices at place(i / nx, j / ny).
template <class Place, class Has>
mesh<triangle> sheet(int nx, int ny, const Place& place, const Has& has)
{
    std::vector<vec3> points;
    std::vector<idx> number(static_cast<std::size_t>((nx + 1) * (ny + 1)), -1);
    triangles cells;
    const auto all = grid_cells(nx, ny);
    for (std::size_t c = 0; c < all.size(); ++c)
    {
        const int quad = static_cast<int>(c / 2);
        if (!has(quad % nx, quad / nx)) continue;
        auto corners = all[c];
        for (idx& v : corners)
        {
            idx& n = number[static_cast<std::size_t>(v)];
            if (n < 0)
            {
                n = static_cast<idx>(points.size());
                points.push_back(place(double(v % (nx + 1)) / nx, double(v / (nx + 1)) / ny));
            }
            v = n;
        }
        cells.push_back(corners);
    }
    return {std::move(points), std::move(cells)};
}

template <class Place>
mesh<triangle> sheet(int nx, int ny, const Place& place)
{
    return sheet(nx, ny, place, [](int, int) { return true; });
}

/// A ramp that winds up around an axis, between radius `inner` and 1: flat, it would be a ring of nearly as many turns.
inline mesh<triangle> ramp(int along, int across, double turns, double inner, double pitch)
{
    return sheet(along, across,
                 [=](double s, double t)
                 {
                     const double a = 2 * std::numbers::pi * turns * s, r = 1 - (1 - inner) * t;
                     return vec3(r * std::cos(a), r * std::sin(a), pitch * turns * s);
                 });
}

/// A ruff: a part of a cone, whose edges at rest are those of a flat ring of so many turns, folded into waves.
inline mesh<triangle> ruff(int along, int across, double turns, double inner, int waves)
{
    return sheet(along, across,
                 [=](double s, double t)
                 {
                     // On the unit sphere a wave around the equator that is `turns` times as long as that.
                     const double a = 1.9 * std::numbers::pi * s, r = 1 - (1 - inner) * t;
                     const double amplitude = 2 * std::sqrt(turns * turns - 1) / waves;
                     const double z = amplitude * std::sin(waves * a), n = r / std::sqrt(1 + z * z);
                     return vec3(n * std::cos(a), n * std::sin(a), n * z);
                 });
}

/// A flat spiral of so many turns whose windings nearly touch, on bumpy ground.
inline mesh<triangle> spiral(int along, int across, double turns, double bump)
{
    return sheet(along, across,
                 [=](double s, double t)
                 {
                     const double a = 2 * std::numbers::pi * turns * s, r = 1 + turns * s - 0.9 * t;
                     const double x = r * std::cos(a), y = r * std::sin(a);
                     return vec3(x, y, bump * std::sin(2.1 * x + 1) * std::cos(1.7 * y));
                 });
}

/// A band around a cone with teeth that point to its top: flat, the teeth are in each other's way.
inline mesh<triangle> comb(int teeth, int wide, int across, double opening)
{
    const int n = 2 * teeth * wide - wide;
    return sheet(
        n, across,
        [=](double s, double t)
        {
            // Teeth run straight on where the cone would end.
            const double a = 1.8 * std::numbers::pi * s, r = 1 - opening * std::min(t, 0.2);
            return vec3(r * std::cos(a), r * std::sin(a), 2 * t);
        },
        [=](int i, int j) { return j < across / 5 || i / wide % 2 == 0; });
}

/// A flat ring with teeth that stand on its inner rim, which has two boundaries: flat, the teeth meet in the middle.
inline mesh<triangle> crown(int teeth, int wide, int across)
{
    constexpr double rim = 0.6; // of the rows
    const auto open = sheet(
        2 * teeth * wide, across,
        [=](double s, double t)
        {
            const double a = 2 * std::numbers::pi * s, r = 2 - 1.3 * std::min(t / rim, 1.0);
            return vec3(r * std::cos(a), r * std::sin(a), std::max(t - rim, 0.0) / (1 - rim));
        },
        [=](int i, int j) { return j < rim * across || i / wide % 2 == 0; });
    // The vertices of the first and of the last column are one.
    std::vector<vec3> points;
    std::vector<idx> number;
    for (const vec3& p : open.points())
    {
        const auto near = [&p](const vec3& q) { return glm::distance(p, q) < 1e-9; };
        const auto found = std::find_if(points.begin(), points.end(), near);
        number.push_back(static_cast<idx>(found - points.begin()));
        if (found == points.end()) points.push_back(p);
    }
    triangles cells = open.cells();
    for (auto& c : cells)
        for (idx& v : c) v = number[static_cast<std::size_t>(v)];
    return {std::move(points), std::move(cells)};
}

} // namespace taut::test
