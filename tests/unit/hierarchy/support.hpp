// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <support/meshes.hpp>
#include <taut/impl/core/hierarchy/make_hierarchy.hpp>

namespace taut::test
{

/// n by n quads of the unit square without a window in the middle: two boundary loops.
inline mesh<triangle> window_frame(int n)
{
    const auto whole = grid(n, n);
    const auto in_window = [](const vec3& p) { return std::max(std::abs(p.x - 0.5), std::abs(p.y - 0.5)) < 0.19; };
    triangles cells;
    for (const auto& t : whole.cells())
    {
        vec3 centre(0.0);
        for (const taut::idx v : t) centre += whole.points()[static_cast<std::size_t>(v)] / 3.0;
        if (!in_window(centre)) cells.push_back(t);
    }
    // Only the vertices that are still used.
    std::vector<taut::idx> number(whole.points().size(), -1);
    std::vector<vec3> points;
    for (auto& t : cells)
        for (taut::idx& v : t)
        {
            auto& to = number[static_cast<std::size_t>(v)];
            if (to < 0)
            {
                to = static_cast<taut::idx>(points.size());
                points.push_back(whole.points()[static_cast<std::size_t>(v)]);
            }
            v = to;
        }
    return {std::move(points), std::move(cells)};
}

/// A strip of needles, 60 times as long as wide, between two strips of good triangles.
inline mesh<triangle> needles(int n)
{
    auto g = grid(n, n);
    std::vector<vec3> points = g.points();
    for (vec3& p : points) p.y = p.y < 0.4 ? p.y : p.y < 0.6 ? 0.4 + (p.y - 0.4) / 60 : p.y - 0.2 + 0.2 / 60;
    return {std::move(points), g.cells()};
}

struct named_mesh
{
    std::string name;
    mesh<triangle> surface;
};

/// Disks and surfaces with holes, smooth and rough, that can be thinned.
inline std::vector<named_mesh> thinnable()
{
    return {{"grid", grid(40, 30)},       {"disk", flat_disk(20)},      {"cap", cap(25, 2.5)},
            {"bumpy", bumpy(40, 0.3, 3)}, {"tube", tube(24, 6)},        {"frame", window_frame(36)},
            {"needles", needles(40)},     {"rough", bumpy(30, 1.5, 7)}, {"torus with hole", torus(24, true)}};
}

/// Flags of the vertices on the boundary.
inline std::vector<char> on_boundary(const mesh<triangle>& m)
{
    std::vector<char> open;
    impl::make_rings(m.cells(), m.points().size(), open, 1);
    return open;
}

} // namespace taut::test
