// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include <support/meshes.hpp>
#include <taut/impl/core/mesh/incidence.hpp>

/// Generated disks whose maps are extremely distorted: the boundary is short and much surface lies behind it.
namespace taut::test
{

/// A tube of radius 1 about the curve path(t), 0 <= t <= 1, closed by a half sphere where t = 0 and open where t = 1.
/// length: of the curve, which has constant speed; around: vertices of a ring, at least 3.
template <class Path>
mesh<triangle> swept_tube(int around, double length, Path path)
{
    constexpr double pi = std::numbers::pi;
    const double spacing = 2 * pi / around;
    const int along = std::max(1, int(std::lround(length / spacing))), dome = std::max(1, around / 4);
    // A frame that turns as little as possible is carried along the curve.
    vec3 tangent = glm::normalize(path(1e-4) - path(0.0));
    vec3 side = glm::normalize(glm::cross(tangent, std::abs(tangent.x) < 0.9 ? vec3(1, 0, 0) : vec3(0, 1, 0)));
    std::vector<vec3> points = {path(0.0) - tangent};
    const auto ring = [&](const vec3& centre, double radius, bool turned)
    {
        const vec3 up = glm::cross(tangent, side);
        for (int i = 0; i < around; ++i)
        {
            const double a = spacing * (i + (turned ? 0.5 : 0.0));
            points.push_back(centre + radius * (std::cos(a) * side + std::sin(a) * up));
        }
    };
    for (int j = 1; j < dome; ++j)
    {
        const double a = pi / 2 * j / dome;
        ring(path(0.0) - std::cos(a) * tangent, std::sin(a), (dome - j) % 2 != 0);
    }
    for (int j = 0; j <= along; ++j)
    {
        const double t = double(j) / along;
        tangent = glm::normalize(path(std::min(1.0, t + 1e-4)) - path(std::max(0.0, t - 1e-4)));
        side = glm::normalize(side - glm::dot(side, tangent) * tangent);
        ring(path(t), 1, j % 2 != 0);
    }
    const int rings = dome + along;
    const auto at = [=](int i, int j) { return taut::idx(1 + j * around + (i + around) % around); };
    triangles cells;
    for (int i = 0; i < around; ++i) cells.push_back({0, at(i + 1, 0), at(i, 0)});
    for (int j = 0; j + 1 < rings; ++j)
        for (int i = 0; i < around; ++i)
            if ((j - dome + 1) % 2 == 0) // the upper ring is half a step ahead
                cells.insert(cells.end(),
                             {{at(i, j), at(i + 1, j), at(i, j + 1)}, {at(i, j), at(i, j + 1), at(i - 1, j + 1)}});
            else
                cells.insert(cells.end(),
                             {{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, {at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
    return {std::move(points), std::move(cells)};
}

/// A straight tube, `aspect` times as long as wide.
inline mesh<triangle> long_tube(int around, double aspect)
{
    return swept_tube(around, 2 * aspect, [=](double t) { return vec3(0, 0, 2 * aspect * t); });
}

/// A tube wound up `turns` times, five times as wide as thick.
inline mesh<triangle> coiled_tube(int around, double turns)
{
    const double radius = 5, rise = 3, round = std::hypot(2 * std::numbers::pi * radius, rise);
    return swept_tube(around, turns * round,
                      [=](double t)
                      {
                          const double a = 2 * std::numbers::pi * turns * t;
                          return vec3(radius * std::cos(a), radius * std::sin(a), rise * turns * t);
                      });
}

/// A closed sphere of 8 * 4^levels triangles.
inline mesh<triangle> sphere(int levels)
{
    const auto start = octahedron();
    std::vector<vec3> points = start.points();
    triangles cells = start.cells();
    for (int l = 0; l < levels; ++l)
    {
        std::map<std::pair<taut::idx, taut::idx>, taut::idx> middle;
        const auto mid = [&](taut::idx a, taut::idx b)
        {
            const auto [at, fresh] = middle.try_emplace(std::minmax(a, b), taut::idx(points.size()));
            if (fresh) points.push_back(glm::normalize(points[std::size_t(a)] + points[std::size_t(b)]));
            return at->second;
        };
        triangles finer;
        for (const auto& [a, b, c] : cells)
        {
            const taut::idx ab = mid(a, b), bc = mid(b, c), ca = mid(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        cells = std::move(finer);
    }
    return {std::move(points), std::move(cells)};
}

/// The surface of the unit cubes (i, j, k), 0 <= i, j, k < n, with inside(i, j, k), smoothed. Cubes that touch must
/// share a face. With open_top the faces at k = n are left out, which opens the body there.
template <class Inside>
mesh<triangle> body(int n, Inside inside, bool open_top = false)
{
    const auto filled = [&](int i, int j, int k) {
        return std::min({i, j, k}) >= 0 && std::max({i, j, k}) < n && inside(i, j, k);
    };
    std::map<std::tuple<int, int, int>, taut::idx> number;
    std::vector<vec3> points;
    triangles cells;
    const auto corner = [&](std::array<int, 3> p)
    {
        const auto [at, fresh] = number.try_emplace(std::tuple(p[0], p[1], p[2]), taut::idx(points.size()));
        if (fresh) points.emplace_back(p[0], p[1], p[2]);
        return at->second;
    };
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
                for (std::size_t axis = 0; axis < 3 && filled(i, j, k); ++axis)
                    for (const int side : {0, 1})
                    {
                        std::array<int, 3> next{i, j, k};
                        next[axis] += side ? 1 : -1;
                        if (filled(next[0], next[1], next[2])) continue;
                        if (open_top && axis == 2 && next[2] == n) continue;
                        std::array<int, 3> p{i, j, k};
                        p[axis] += side;
                        std::array<taut::idx, 4> q;
                        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
                        q[0] = corner(p), ++p[u], q[1] = corner(p), ++p[v], q[2] = corner(p), --p[u], q[3] = corner(p);
                        if (side == 0) std::swap(q[1], q[3]);
                        if ((i + j + k) % 2 == 0)
                            cells.insert(cells.end(), {{q[0], q[1], q[2]}, {q[0], q[2], q[3]}});
                        else
                            cells.insert(cells.end(), {{q[0], q[1], q[3]}, {q[1], q[2], q[3]}});
                    }
    for (int round = 0; round < 3; ++round)
    {
        std::vector<vec3> sum(points.size(), vec3(0.0));
        std::vector<double> count(points.size(), 0);
        for (const auto& t : cells)
            for (std::size_t c = 0; c < 3; ++c)
            {
                sum[std::size_t(t[c])] += points[std::size_t(t[(c + 1) % 3])] + points[std::size_t(t[(c + 2) % 3])];
                count[std::size_t(t[c])] += 2;
            }
        for (std::size_t v = 0; v < points.size(); ++v) points[v] = 0.5 * points[v] + 0.5 * sum[v] / count[v];
    }
    return {std::move(points), std::move(cells)};
}

/// Tubes of square section, `width` wide and n / 2 long, in the six directions from a common middle; one is open.
inline mesh<triangle> star_of_tubes(int n, int width)
{
    const auto middle = [=](int i) { return 2 * i >= n - width && 2 * i < n + width; };
    return body(
        n, [=](int i, int j, int k) { return int(middle(i)) + int(middle(j)) + int(middle(k)) >= 2; }, true);
}

/// A closed four-legged body with a neck, a head, horns and a tail, on a grid of n^3; n at least 24.
inline mesh<triangle> animal(int n)
{
    // Boxes in twenty-fourths of the grid: low and high corner.
    constexpr std::array<std::array<int, 6>, 10> boxes{{{4, 8, 9, 18, 16, 15},
                                                        {4, 8, 0, 6, 10, 9},
                                                        {4, 14, 0, 6, 16, 9},
                                                        {16, 8, 0, 18, 10, 9},
                                                        {16, 14, 0, 18, 16, 9},
                                                        {16, 10, 15, 19, 14, 19},
                                                        {16, 9, 18, 23, 15, 22},
                                                        {17, 9, 22, 18, 10, 24},
                                                        {17, 14, 22, 18, 15, 24},
                                                        {1, 11, 13, 4, 12, 14}}};
    return body(n,
                [=](int i, int j, int k)
                {
                    const auto in = [n](int x, int low, int high) { return x * 24 >= low * n && x * 24 < high * n; };
                    return std::any_of(boxes.begin(), boxes.end(),
                                       [&](const auto& b)
                                       { return in(i, b[0], b[3]) && in(j, b[1], b[4]) && in(k, b[2], b[5]); });
                });
}

/// A closed surface cut open along the shortest path of edges from vertex `from`, `edges` of them (2 at least), that
/// ends as far away as so many edges reach: a disk with 2 * edges boundary vertices.
inline mesh<triangle> slit(const mesh<triangle>& closed, int edges, taut::idx from = 0)
{
    // Breadth first, as far as the path is long.
    const auto around = impl::vertex_neighbours(closed);
    std::vector<taut::idx> before(closed.points().size(), -1), reached = {from};
    std::vector<int> depth(closed.points().size(), -1);
    depth[std::size_t(from)] = 0;
    for (std::size_t r = 0; depth[std::size_t(reached[r])] < edges; ++r)
        for (const taut::idx w : around.row(reached[r]))
            if (depth[std::size_t(w)] < 0)
            {
                depth[std::size_t(w)] = depth[std::size_t(reached[r])] + 1;
                before[std::size_t(w)] = reached[r];
                reached.push_back(w);
            }
    std::vector<taut::idx> path = {reached.back()};
    while (path.back() != from) path.push_back(before[std::size_t(path.back())]);

    // Inner vertices of the path are doubled: triangles to its left keep the old one, those to its right get the new.
    std::map<std::pair<taut::idx, taut::idx>, std::size_t> left; // directed edge -> its triangle
    for (std::size_t c = 0; c < closed.cells().size(); ++c)
        for (std::size_t k = 0; k < 3; ++k) left[{closed.cells()[c][k], closed.cells()[c][(k + 1) % 3]}] = c;
    std::vector<vec3> points = closed.points();
    triangles cells = closed.cells();
    for (std::size_t p = 1; p + 1 < path.size(); ++p)
    {
        const taut::idx v = path[p];
        const auto twin = taut::idx(points.size());
        points.push_back(points[std::size_t(v)]);
        // Turn about v from the edge to the next vertex of the path to the edge to the one before.
        for (taut::idx w = path[p + 1]; w != path[p - 1];)
        {
            const std::size_t c = left.at({w, v});
            const auto& t = closed.cells()[c];
            const std::size_t k = std::size_t(std::find(t.begin(), t.end(), v) - t.begin());
            cells[c][k] = twin;
            w = t[(k + 1) % 3];
        }
    }
    return {std::move(points), std::move(cells)};
}

} // namespace taut::test
