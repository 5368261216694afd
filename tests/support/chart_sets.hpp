// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <taut/types.hpp>

namespace support
{

/// Charts as packing gets them.
struct chart_set
{
    std::vector<taut::vec2> uv;
    std::vector<std::array<taut::idx, 3>> cells;
    std::vector<taut::idx> first_cell{0}, first_vertex{0};

    taut::idx charts() const { return static_cast<taut::idx>(first_cell.size()) - 1; }

    /// Appends a chart: the squares of an n x n grid over [-1, 1]^2 whose centres are inside, halved, and moved.
    template <class Inside, class Move>
    void add(int n, Inside&& inside, Move&& move)
    {
        std::map<std::pair<int, int>, taut::idx> numbers;
        const auto at = [n](int i) { return 2.0 * i / n - 1; };
        const auto vertex = [&](int i, int j)
        {
            const auto [found, fresh] = numbers.try_emplace({i, j}, static_cast<taut::idx>(uv.size()));
            if (fresh) uv.push_back(move(taut::vec2(at(i), at(j))));
            return found->second;
        };
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
            {
                if (!inside(taut::vec2(at(i) + 1.0 / n, at(j) + 1.0 / n))) continue;
                const auto a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
                if ((i + j) % 2 == 0)
                {
                    cells.push_back({a, b, c});
                    cells.push_back({a, c, d});
                }
                else
                {
                    cells.push_back({a, b, d});
                    cells.push_back({b, c, d});
                }
            }
        first_cell.push_back(static_cast<taut::idx>(cells.size()));
        first_vertex.push_back(static_cast<taut::idx>(uv.size()));
    }

    /// Appends a rectangle of two triangles with its centre at 0, turned.
    void add_rectangle(double width, double height, double angle = 0)
    {
        const taut::vec2 axis(std::cos(angle), std::sin(angle));
        add(
            1, [](taut::vec2) { return true; },
            [&](taut::vec2 p)
            {
                p *= taut::vec2(width / 2, height / 2);
                return taut::vec2(axis.x * p.x - axis.y * p.y, axis.y * p.x + axis.x * p.y);
            });
    }
};

/// Charts as a segmentation leaves them: blobs with waves, strips, L and C shapes, annuli and slivers with ragged
/// outlines, of areas that differ by a factor of about `spread`, each of about so many triangles.
inline chart_set ragged_charts(int charts, int triangles, double spread, std::uint32_t seed)
{
    chart_set set;
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high)
    { return low + (high - low) * static_cast<double>(random()) / 4294967296.0; };
    for (int c = 0; c < charts; ++c)
    {
        const double size = std::pow(spread, uniform(0, 0.5)), turn = uniform(0, 2 * std::numbers::pi);
        const double waves = std::floor(uniform(2, 7)), depth = uniform(0, 0.35), phase = uniform(0, 6);
        const double kind = uniform(0, 10), width = uniform(0.25, 0.6);
        const auto inside = [&](taut::vec2 p)
        {
            const double r = glm::length(p), a = std::atan2(p.y, p.x);
            const double edge = 1 - depth * (1 + std::sin(waves * a + phase)) / 2;
            if (kind < 5) return r < edge;                                      // a blob
            if (kind < 6.5) return std::abs(p.y) < width;                       // a strip
            if (kind < 7.5) return p.x < 2 * width - 1 || p.y < 2 * width - 1;  // an L
            if (kind < 8.5) return r < 1 && r > 1 - width && std::abs(a) > 0.5; // a C
            if (kind < 9) return r < edge && r > 0.4;                           // an annulus
            return std::abs(p.y) < 0.12 + 0.05 * std::sin(3 * p.x);             // a sliver
        };
        const double share = kind < 5 ? 0.65 : kind < 6.5 ? width : kind < 9 ? 0.55 : 0.15;
        const int n = std::max(8, static_cast<int>(std::sqrt(triangles / 2.0 / share)));
        const taut::vec2 axis(std::cos(turn), std::sin(turn)), shift(uniform(-9, 9), uniform(-9, 9));
        set.add(n, inside,
                [&](taut::vec2 p)
                {
                    p += 0.08 * taut::vec2(std::sin(5 * p.y + phase), std::cos(4 * p.x + phase));
                    p += 0.2 / n * taut::vec2(std::sin(91 * p.x + 57 * p.y), std::sin(83 * p.y - 61 * p.x));
                    return size * taut::vec2(axis.x * p.x - axis.y * p.y, axis.y * p.x + axis.x * p.y) + shift;
                });
    }
    return set;
}

} // namespace support
