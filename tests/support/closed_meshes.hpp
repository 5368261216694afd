// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <vector>

#include <taut/mesh.hpp>

/// Closed surfaces for tests, and such with handles and holes.
namespace taut::test
{

using cube_cell = std::array<int, 3>;

/// The surface of a union of unit cubes, each of its squares as n by n quads of two triangles. Cubes that touch only
/// in an edge or a vertex make it no manifold.
inline mesh<triangle> cubes(const std::set<cube_cell>& filled, int n)
{
    std::map<cube_cell, idx> vertices;
    std::vector<vec3> points;
    std::vector<std::array<idx, 3>> cells;
    const auto vertex = [&](const cube_cell& at)
    {
        const auto [place, fresh] = vertices.try_emplace(at, static_cast<idx>(points.size()));
        if (fresh) points.push_back(vec3(at[0], at[1], at[2]) / double(n));
        return place->second;
    };
    for (const auto& cube : filled)
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const int side : {0, 1})
            {
                cube_cell beyond = cube;
                beyond[axis] += side == 1 ? 1 : -1;
                if (filled.contains(beyond)) continue;
                const std::size_t p = (axis + 1) % 3, q = (axis + 2) % 3;
                for (int j = 0; j < n; ++j)
                    for (int i = 0; i < n; ++i)
                    {
                        const auto at = [&](int di, int dj)
                        {
                            cube_cell x{};
                            x[axis] = n * (cube[axis] + side);
                            x[p] = n * cube[p] + i + di;
                            x[q] = n * cube[q] + j + dj;
                            return vertex(x);
                        };
                        const idx a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
                        if (side == 1)
                            cells.insert(cells.end(), {{a, b, c}, {a, c, d}});
                        else
                            cells.insert(cells.end(), {{a, c, b}, {a, d, c}});
                    }
            }
    return {std::move(points), std::move(cells)};
}

/// A cube.
inline mesh<triangle> box(int n)
{
    return cubes({{0, 0, 0}}, n);
}

/// A plate with `handles` square holes through it, in a row.
inline mesh<triangle> pierced_plate(int handles, int n)
{
    std::set<cube_cell> filled;
    for (int i = 0; i < 2 * handles + 1; ++i)
        for (int j = 0; j < 3; ++j)
            if (i % 2 == 0 || j != 1) filled.insert({i, j, 0});
    return cubes(filled, n);
}

/// Vertices moved: x becomes place(x).
template <class Place>
mesh<triangle> moved(const mesh<triangle>& m, Place place)
{
    auto points = m.points();
    for (vec3& p : points) p = place(p);
    return {std::move(points), m.cells()};
}

/// The unit sphere, of 12 n^2 triangles.
inline mesh<triangle> ball(int n)
{
    return moved(box(n),
                 [](const vec3& p)
                 {
                     const vec3 x = 2.0 * p - 1.0; // and spread evenly
                     return glm::normalize(vec3(std::tan(0.8 * x.x), std::tan(0.8 * x.y), std::tan(0.8 * x.z)));
                 });
}

/// Vertices moved at random by up to `size` in each coordinate.
inline mesh<triangle> noisy(const mesh<triangle>& m, double size, std::uint32_t seed = 1)
{
    std::mt19937 random(seed);
    const auto shift = [&] { return size * (2.0 * double(random()) / 4294967295.0 - 1); };
    return moved(m,
                 [&](const vec3& p)
                 {
                     const double x = shift(), y = shift(), z = shift();
                     return p + vec3(x, y, z);
                 });
}

/// Without the triangles that `drop` names.
template <class Drop>
mesh<triangle> without(const mesh<triangle>& m, Drop drop)
{
    std::vector<std::array<idx, 3>> cells;
    std::vector<idx> number(m.points().size(), -1);
    std::vector<vec3> points;
    for (idx c = 0; c < m.cell_count(); ++c)
    {
        if (drop(c)) continue;
        auto t = m.cells()[static_cast<std::size_t>(c)];
        for (idx& v : t)
        {
            idx& n = number[static_cast<std::size_t>(v)];
            if (n < 0)
            {
                n = static_cast<idx>(points.size());
                points.push_back(m.points()[static_cast<std::size_t>(v)]);
            }
            v = n;
        }
        cells.push_back(t);
    }
    return {std::move(points), std::move(cells)};
}

/// Two surfaces as one, side by side.
inline mesh<triangle> both(const mesh<triangle>& a, const mesh<triangle>& b)
{
    auto points = a.points();
    auto cells = a.cells();
    const idx first = a.vertex_count();
    for (const vec3& p : b.points()) points.push_back(p + vec3(10, 0, 0));
    for (const auto& t : b.cells()) cells.push_back({t[0] + first, t[1] + first, t[2] + first});
    return {std::move(points), std::move(cells)};
}

} // namespace taut::test
