// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/core/parallel.hpp>
#include <taut/impl/core/exact/predicates.hpp>
#include <taut/types.hpp>

namespace taut::impl
{

/// Borders of charts: edges as pairs of vertices, chart after chart, with the inside to the left. Clockwise triangles
/// are reversed first, so points covered by a chart have a winding number of at least 1, folded or not.
struct chart_outlines
{
    std::vector<std::array<idx, 2>> edges;
    std::vector<idx> cells; ///< the triangle that the edge is from, one per edge
    std::vector<idx> first; ///< #charts + 1: of edges
    std::vector<double> areas;
    bool turned = false; ///< whether a triangle was clockwise; if not, borders are the same wherever no triangle is

    idx charts() const { return static_cast<idx>(first.size()) - 1; }
};

/// Throws packing_error.
inline void check_charts(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells,
                         std::span<const idx> first_cell, std::span<const idx> first_vertex)
{
    for (std::size_t v = 0; v < uv.size(); ++v)
        if (!finite(uv[v]))
            throw packing_error(packing_error::not_finite, {static_cast<idx>(v)},
                                "vertex " + std::to_string(v) + " is not finite; flatten its chart again");
    std::vector<idx> empty;
    for (std::size_t c = 0; c + 1 < first_cell.size(); ++c)
    {
        if (first_cell[c] == first_cell[c + 1]) empty.push_back(static_cast<idx>(c));
        for (idx t = first_cell[c]; t < first_cell[c + 1]; ++t)
            for (const idx v : cells[static_cast<std::size_t>(t)])
                if (v < first_vertex[c] || v >= first_vertex[c + 1])
                    throw packing_error(packing_error::out_of_range, {t},
                                        "triangle " + std::to_string(t) + " of chart " + std::to_string(c) +
                                            " has vertex " + std::to_string(v) +
                                            ", which is not one of that chart; give each chart its own vertices");
    }
    if (!empty.empty())
    {
        const std::string message = "chart " + std::to_string(empty.front()) + " has no triangle; leave it out";
        throw packing_error(packing_error::no_triangle, std::move(empty), message);
    }
}

/// Appends the border of one chart, of cells [first, last) and vertices [v0, v1).
inline void append_outline(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells, idx first, idx last,
                           idx v0, idx v1, chart_outlines& outlines)
{
    struct side
    {
        idx to;   // the larger end
        int sign; // 1: from the smaller to the larger one
        idx cell;
    };
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    static thread_local std::vector<idx> start;
    static thread_local std::vector<char> turned;
    static thread_local std::vector<side> sides;
    start.assign(u(v1 - v0) + 2, 0); // of the sides of each vertex, the smaller of their ends
    const auto for_each_side = [&](auto&& body)
    {
        for (idx t = first; t < last; ++t)
            for (std::size_t k = 0; k < 3; ++k) body(t, cells[u(t)][k], cells[u(t)][(k + 1) % 3]);
    };
    for_each_side([&](idx, idx a, idx b) { ++start[u(std::min(a, b) - v0) + 2]; });
    for (std::size_t v = 2; v < start.size(); ++v) start[v] += start[v - 1];
    auto& [edges, origins, ends, areas, any_turned] = outlines;
    const std::size_t before = edges.size();
    double area = 0;
    turned.resize(u(last - first));
    for (idx t = first; t < last; ++t)
    {
        const auto& [a, b, c] = cells[u(t)];
        const auto o = orient(uv[u(a)], uv[u(b)], uv[u(c)]);
        turned[u(t - first)] = o.sign < 0;
        any_turned = any_turned || o.sign < 0;
        area += std::abs(o.det) / 2;
    }
    sides.resize(3 * u(last - first));
    for_each_side(
        [&](idx t, idx a, idx b)
        {
            const bool forward = (a < b) != static_cast<bool>(turned[u(t - first)]);
            sides[u(start[u(std::min(a, b) - v0) + 1]++)] = {std::max(a, b), forward ? 1 : -1, t};
        });
    for (idx v = v0; v < v1; ++v)
    {
        const auto begin = sides.begin() + start[u(v - v0)], end = sides.begin() + start[u(v - v0) + 1];
        std::sort(begin, end,
                  [](const side& a, const side& b) { return std::pair(a.to, a.cell) < std::pair(b.to, b.cell); });
        for (auto s = begin; s != end;)
        {
            auto next = s;
            int sum = 0;
            for (; next != end && next->to == s->to; ++next) sum += next->sign;
            for (auto k = s; k != next && sum != 0; ++k) // what is not cancelled, from the first triangles
            {
                if (k->sign * sum < 0) continue;
                edges.push_back(sum > 0 ? std::array{v, s->to} : std::array{s->to, v});
                origins.push_back(k->cell);
                sum -= k->sign;
            }
            s = next;
        }
    }
    for (std::size_t k = 0; k < 3 && edges.size() == before + k; ++k) // flat triangles that all cancel each other
    {
        edges.push_back({cells[u(first)][k], cells[u(first)][(k + 1) % 3]});
        origins.push_back(first);
    }
    areas.push_back(area);
    ends.push_back(static_cast<idx>(edges.size()));
}

inline chart_outlines find_outlines(std::span<const vec2> uv, std::span<const std::array<idx, 3>> cells,
                                    std::span<const idx> first_cell, std::span<const idx> first_vertex)
{
    const std::size_t charts = first_cell.size() - 1;
    constexpr std::size_t piece = 64; // charts, mostly small ones
    std::vector<chart_outlines> parts((charts + piece - 1) / piece);
    parallel_for(
        parts.size(),
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t p = begin; p < end; ++p)
                for (std::size_t c = p * piece; c < std::min(charts, (p + 1) * piece); ++c)
                    append_outline(uv, cells, first_cell[c], first_cell[c + 1], first_vertex[c], first_vertex[c + 1],
                                   parts[p]);
        },
        0, 1);
    chart_outlines outlines;
    outlines.first.push_back(0);
    for (const chart_outlines& part : parts)
    {
        const auto before = static_cast<idx>(outlines.edges.size());
        for (const idx end : part.first) outlines.first.push_back(before + end);
        outlines.edges.insert(outlines.edges.end(), part.edges.begin(), part.edges.end());
        outlines.cells.insert(outlines.cells.end(), part.cells.begin(), part.cells.end());
        outlines.areas.insert(outlines.areas.end(), part.areas.begin(), part.areas.end());
        outlines.turned = outlines.turned || part.turned;
    }
    return outlines;
}

} // namespace taut::impl
