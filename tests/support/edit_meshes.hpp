// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <support/meshes.hpp>

namespace taut::test
{

/// A closed sphere of radius 1: an octahedron whose triangles are split into four so many times.
inline mesh<triangle> sphere(int splits)
{
    auto points = octahedron().points();
    auto cells = octahedron().cells();
    for (int round = 0; round < splits; ++round)
    {
        std::map<std::pair<taut::idx, taut::idx>, taut::idx> middles;
        const auto middle = [&](taut::idx a, taut::idx b)
        {
            const auto [found, is_new] = middles.emplace(std::minmax(a, b), static_cast<taut::idx>(points.size()));
            if (is_new) points.push_back(glm::normalize(points[std::size_t(a)] + points[std::size_t(b)]));
            return found->second;
        };
        triangles finer;
        for (const auto& [a, b, c] : cells)
        {
            const taut::idx ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        cells = std::move(finer);
    }
    return {std::move(points), std::move(cells)};
}

/// A plane disk of radius 2 with a mushroom in its middle, whose hat overhangs its stem; vertex 0 is its top.
inline mesh<triangle> mushroom(int n)
{
    return rings(
        n,
        [](double r, double a)
        {
            const std::array<vec2, 6> profile{{{0, 1}, {0.45, 0.85}, {0.5, 0.7}, {0.25, 0.6}, {0.3, 0}, {2, 0}}};
            const double t = 5 * r;
            const auto k = std::min<std::size_t>(4, static_cast<std::size_t>(t));
            const vec2 p = profile[k] + (t - double(k)) * (profile[k + 1] - profile[k]);
            return vec3(p.x * std::cos(a), p.x * std::sin(a), p.y);
        });
}

} // namespace taut::test
