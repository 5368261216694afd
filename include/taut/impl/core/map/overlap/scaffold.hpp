// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/exact/refine_triangulation.hpp>

namespace taut::impl
{

/// Scaffold: triangles that fill the complement of the image of a surface in a rectangle around it, holes too. A map of
/// the surface and these without flips has a simple boundary (Jiang, Schaefer, Panozzo 2017, "Simplicial complex
/// augmentation framework for bijective maps").
struct scaffold
{
    std::vector<vec2> points;              ///< that follow those of the map; first the rectangle's four corners
    std::vector<std::array<idx, 3>> cells; ///< positive
};

/// Adds the vertices of loops, each begun where its neighbour lies: every 2^k-th of a loop, for less and less k, so
/// that a long curve is no worst case. numbers: one per point of x, set where a loop has it.
inline void add_loops(planar_triangulation& t, std::span<const std::vector<idx>> loops, std::span<const vec2> x,
                      std::vector<idx>& numbers)
{
    for (const auto& loop : loops)
    {
        const auto number = [&](std::size_t k) -> idx& { return numbers[static_cast<std::size_t>(loop[k])]; };
        const auto at = [&](std::size_t k) { return x[static_cast<std::size_t>(loop[k])]; };
        std::size_t stride = 1;
        while (stride < loop.size()) stride *= 2;
        number(0) = t.add(at(0));
        for (; stride > 0; stride /= 2)
            for (std::size_t k = stride; k < loop.size(); k += 2 * stride) number(k) = t.add(at(k), number(k - stride));
    }
}

/// Marks the triangles within loops whose edges are fixed, each with the inside to its left. loops: vertices of t.
inline std::vector<char> triangles_within(const planar_triangulation& t, std::span<const std::vector<idx>> loops)
{
    std::vector<char> within(t.cells().size(), 0);
    std::vector<idx> front;
    const auto mark = [&](idx cell)
    {
        if (!std::exchange(within[static_cast<std::size_t>(cell)], char(1))) front.push_back(cell);
    };
    for (const auto& loop : loops)
        for (std::size_t k = 0; k < loop.size(); ++k) mark(t.side_between(loop[k], loop[(k + 1) % loop.size()]) / 3);
    while (!front.empty())
    {
        const idx c = front.back();
        front.pop_back();
        for (idx s = 3 * c; s < 3 * c + 3; ++s)
            if (t.twin(s) != planar_triangulation::none && !t.is_fixed(s)) mark(t.twin(s) / 3);
    }
    return within;
}

/// Makes the scaffold between an image with a simple boundary and a rectangle around it.
/// loops: the boundary, with the image to the left; x: one point per vertex of the map.
inline scaffold make_scaffold(std::span<const std::vector<idx>> loops, std::span<const vec2> x, const vec2& low,
                              const vec2& high)
{
    planar_triangulation t(low, high);
    std::vector<idx> numbers(x.size(), planar_triangulation::none);
    add_loops(t, loops, x, numbers);
    std::vector<std::vector<idx>> local(loops.begin(), loops.end());
    std::size_t edges = 0;
    for (auto& loop : local)
    {
        for (idx& v : loop) v = numbers[static_cast<std::size_t>(v)];
        for (std::size_t k = 0; k < loop.size(); ++k) t.fix(loop[k], loop[(k + 1) % loop.size()]);
        edges += loop.size();
    }
    const auto within = triangles_within(t, local);
    std::vector<char> outside;
    for (const char inside : within) outside.push_back(!inside);
    refine(t, outside, 20 * edges + 1000);

    std::vector<idx> back(t.points().size(), planar_triangulation::none);
    for (std::size_t v = 0; v < numbers.size(); ++v)
        if (numbers[v] != planar_triangulation::none) back[static_cast<std::size_t>(numbers[v])] = static_cast<idx>(v);
    scaffold made;
    for (std::size_t v = 0; v < back.size(); ++v)
        if (back[v] == planar_triangulation::none)
        {
            back[v] = static_cast<idx>(x.size() + made.points.size());
            made.points.push_back(t.points()[v]);
        }
    for (std::size_t c = 0; c < t.cells().size(); ++c)
    {
        if (c < within.size() && within[c]) continue;
        auto corners = t.cells()[c];
        for (idx& v : corners) v = back[static_cast<std::size_t>(v)];
        made.cells.push_back(corners);
    }
    return made;
}

} // namespace taut::impl
