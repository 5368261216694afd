// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/types.hpp>

namespace taut::impl
{

/// Cells [begin, end) of a row.
struct cell_run
{
    idx begin, end;
};

/// Cells of a grid of squares of side 1, row by row from row `low`, in runs from left to right that do not touch.
struct cell_rows
{
    idx low = 0;
    std::vector<idx> first{0}; ///< #rows + 1
    std::vector<cell_run> runs;

    idx rows() const { return static_cast<idx>(first.size()) - 1; }
    std::span<const cell_run> row(idx r) const
    {
        const auto i = static_cast<std::size_t>(r);
        return {runs.data() + first[i], static_cast<std::size_t>(first[i + 1] - first[i])};
    }
};

/// The largest x of the points within r of segment pq whose y is in [y0, y1]; there is one.
inline double rightmost_within(const vec2& p, const vec2& q, double r, double y0, double y1)
{
    // The bound is concave in y: the row looks at its peak, or at the side nearest to that.
    const double peak = p.x == q.x ? std::clamp(y0, std::min(p.y, q.y), std::max(p.y, q.y)) : p.x > q.x ? p.y : q.y;
    const double most = std::max(p.x, q.x) + r;
    if (y0 <= peak && peak <= y1) return most;
    const double y = peak > y1 ? y1 : y0;
    double x = std::min(p.x, q.x) - r;
    for (const vec2& c : {p, q})
        if (const double square = r * r - (y - c.y) * (y - c.y); square >= 0) x = std::max(x, c.x + std::sqrt(square));
    const vec2 d = p.y < q.y ? q - p : p - q; // upwards: its right side faces right
    if (d.y > 0)
    {
        const vec2 side = (p.y < q.y ? p : q) + r / glm::length(d) * vec2(d.y, -d.x);
        const double t = (y - side.y) / d.y;
        if (t >= 0 && t <= 1) x = std::max(x, side.x + t * d.x);
    }
    return x;
}

/// All cells with a point within r >= 0 of what closed outlines wind around.
/// edges: their ends, in cells
inline cell_rows rasterize(std::span<const std::array<vec2, 2>> edges, double r)
{
    struct mark
    {
        idx row, begin, end;
    };
    struct crossing
    {
        idx row;
        double x;
        int winding;
    };
    const auto cell = [](double x) { return static_cast<idx>(std::floor(x)); };
    static thread_local std::vector<mark> marks, sorted;
    static thread_local std::vector<crossing> crossings;
    marks.clear();
    crossings.clear();
    idx low = cell(edges[0][0].y), high = low;
    for (const auto& [p, q] : edges)
    {
        const double bottom = std::min(p.y, q.y), top = std::max(p.y, q.y);
        const idx first = cell(bottom - r), last = cell(top + r);
        low = std::min(low, first);
        high = std::max(high, last);
        for (idx row = first; row <= last; ++row)
        {
            const double left = -rightmost_within({-p.x, p.y}, {-q.x, q.y}, r, row, row + 1);
            marks.push_back({row, cell(left), cell(rightmost_within(p, q, r, row, row + 1)) + 1});
        }
        for (idx row = cell(bottom - 0.5); row + 0.5 < top; ++row)
            if (row + 0.5 >= bottom)
                crossings.push_back({row, p.x + (q.x - p.x) * ((row + 0.5 - p.y) / (q.y - p.y)), p.y < q.y ? 1 : -1});
    }
    // What is between two crossings is covered where the winding number says so. Both lie in cells that are marked.
    std::sort(crossings.begin(), crossings.end(),
              [](const crossing& a, const crossing& b) { return std::pair(a.row, a.x) < std::pair(b.row, b.x); });
    int winding = 0;
    for (std::size_t k = 0; k + 1 < crossings.size(); ++k)
    {
        const auto &a = crossings[k], &b = crossings[k + 1];
        winding = (k > 0 && crossings[k - 1].row != a.row ? 0 : winding) + a.winding;
        if (a.row == b.row && winding != 0) marks.push_back({a.row, cell(a.x), cell(b.x) + 1});
    }

    cell_rows cells;
    cells.low = low;
    const auto rows = static_cast<std::size_t>(high - low) + 1;
    std::vector<idx> start(rows + 1, 0);
    for (const mark& m : marks) ++start[static_cast<std::size_t>(m.row - low) + 1];
    for (std::size_t i = 1; i <= rows; ++i) start[i] += start[i - 1];
    sorted.resize(marks.size());
    auto next = start;
    for (const mark& m : marks) sorted[static_cast<std::size_t>(next[static_cast<std::size_t>(m.row - low)]++)] = m;
    cells.first.assign(rows + 1, 0);
    for (std::size_t i = 0; i < rows; ++i)
    {
        const auto begin = sorted.begin() + start[i], end = sorted.begin() + start[i + 1];
        std::sort(begin, end, [](const mark& a, const mark& b) { return a.begin < b.begin; });
        const std::size_t before = cells.runs.size();
        for (auto m = begin; m != end; ++m)
            if (cells.runs.size() > before && m->begin <= cells.runs.back().end)
                cells.runs.back().end = std::max(cells.runs.back().end, m->end);
            else
                cells.runs.push_back({m->begin, m->end});
        cells.first[i + 1] = static_cast<idx>(cells.runs.size());
    }
    return cells;
}

} // namespace taut::impl
