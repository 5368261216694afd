// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/charts/repair/placed_triangles.hpp>

/// Consistent orientation: the triangles to be reversed so that neighbours agree.
namespace taut::impl
{

struct winding
{
    std::vector<char> turned; ///< one per triangle
    std::vector<idx> sheet;   ///< one per triangle: what hangs together, by its first triangle
    std::vector<idx> cut;     ///< one side of each edge where no choice agrees
};

/// Turns the triangles of one sheet, which contradict each other, to one of the two ways. cells: those of the sheet
inline void choose_way(const placed_triangles& t, std::span<const idx> cells, bool closed, std::vector<char>& turned)
{
    double volume = 0, area = 0; // 6 times inside; of those that stay less of those that turn
    const vec3 from = t.rest(cells[0])[0];
    for (const idx c : cells)
    {
        const auto x = t.rest(c);
        const vec3 normal = glm::cross(x[1] - x[0], x[2] - x[0]);
        const double sign = turned[static_cast<std::size_t>(c)] != 0 ? -1 : 1;
        volume += sign * glm::dot(x[0] - from, normal);
        area += sign * glm::length(normal);
    }
    if ((closed ? volume : area) >= 0) return;
    for (const idx c : cells) turned[static_cast<std::size_t>(c)] ^= 1;
}

/// Spreads the winding of a triangle over what hangs together with it, breadth first, so that what must be cut of a
/// one-sided part is where two fronts meet: about as short as can be. What edges of the input join goes before what is
/// stitched: a part of the input that agrees with itself is flipped as a whole or not at all. Polygons are reached as a
/// whole, so that none is cut.
/// twin: the other side of each side, or -1
inline winding wind(const placed_triangles& t, std::span<const idx> twin)
{
    const std::size_t n = t.origins.size();
    winding w{std::vector<char>(n, 0), std::vector<idx>(n, -1), {}};
    std::vector<idx> cells; // of a sheet, in the order in which they are reached
    std::vector<idx> sewn;  // sides whose twins are to be looked at
    const auto wanted = [&](idx side, idx other)
    { return static_cast<char>(w.turned[static_cast<std::size_t>(side / 3)] ^ (t.clash(side, other) ? 1 : 0)); };
    const auto take = [&](idx side, idx other)
    {
        const auto c = static_cast<std::size_t>(other / 3);
        if (w.sheet[c] >= 0) return;
        w.sheet[c] = cells[0];
        w.turned[c] = wanted(side, other);
        cells.push_back(other / 3);
    };
    const auto take_polygon = [&](std::size_t from) // of the cell there
    {
        for (std::size_t k = from; k < cells.size(); ++k)
            for (idx s = 3 * cells[k]; s < 3 * cells[k] + 3; ++s)
                if (const idx mate = twin[static_cast<std::size_t>(s)]; mate >= 0 && t.together(s, mate)) take(s, mate);
    };
    const auto reach = [&](idx side, idx other)
    {
        const std::size_t from = cells.size();
        take(side, other);
        take_polygon(from);
    };
    for (std::size_t first = 0; first < n; ++first)
    {
        if (w.sheet[first] >= 0) continue;
        cells.assign(1, static_cast<idx>(first));
        sewn.clear();
        w.sheet[first] = cells[0];
        take_polygon(0);
        bool closed = true, contradicts = false;
        for (std::size_t i = 0, k = 0; i < cells.size() || k < sewn.size();)
        {
            if (i == cells.size())
            {
                reach(sewn[k], twin[static_cast<std::size_t>(sewn[k])]);
                ++k;
                continue;
            }
            for (idx s = 3 * cells[i]; s < 3 * cells[i] + 3; ++s)
                if (const idx other = twin[static_cast<std::size_t>(s)]; other < 0)
                    closed = false;
                else if (contradicts = contradicts || t.clash(s, other); t.edge(s) == t.edge(other))
                    reach(s, other);
                else
                    sewn.push_back(s);
            ++i;
        }
        const std::size_t cuts = w.cut.size();
        if (contradicts)
            for (const idx c : cells)
                for (idx s = 3 * c; s < 3 * c + 3; ++s)
                    if (const idx other = twin[static_cast<std::size_t>(s)];
                        s < other && w.turned[static_cast<std::size_t>(other / 3)] != wanted(s, other))
                        w.cut.push_back(s);
        if (contradicts) choose_way(t, cells, closed && w.cut.size() == cuts, w.turned);
    }
    return w;
}

} // namespace taut::impl
