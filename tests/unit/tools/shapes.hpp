// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <picture/image.hpp>

using cell_list = std::vector<std::array<taut::idx, 3>>;

/// n x n unit squares, each cut in two counter-clockwise triangles.
struct grid_mesh
{
    std::vector<taut::vec2> uv;
    std::vector<taut::vec3> points; ///< uv on a cylinder of radius n around y, outside towards +z
    cell_list cells;
    std::vector<std::vector<taut::idx>> loops;

    explicit grid_mesh(int n) : loops(1)
    {
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i)
            {
                const double angle = i / double(n) - 0.5;
                uv.emplace_back(i, j);
                points.emplace_back(n * std::sin(angle), j, n * std::cos(angle));
            }
        const auto at = [n](int i, int j) { return static_cast<taut::idx>(j * (n + 1) + i); };
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
            {
                cells.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
                cells.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
            }
        for (int k = 0; k < n; ++k) loops[0].push_back(at(k, 0));
        for (int k = 0; k < n; ++k) loops[0].push_back(at(n, k));
        for (int k = 0; k < n; ++k) loops[0].push_back(at(n - k, n));
        for (int k = 0; k < n; ++k) loops[0].push_back(at(0, n - k));
    }
};

template <class Predicate>
int count_pixels(const taut::io::image& picture, Predicate&& predicate)
{
    int count = 0;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) count += predicate(picture(x, y)) ? 1 : 0;
    return count;
}

inline int count_pixels(const taut::io::image& picture, taut::io::rgb color)
{
    return count_pixels(picture, [color](taut::io::rgb c) { return c == color; });
}
