// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/facets.hpp>
#include <taut/impl/core/mesh/ideal.hpp>
#include <taut/impl/core/mesh/manifold.hpp>

/// Triangles that can be computed with, as a mesh whose vertices are places: those of the input at one place are one.
namespace taut::impl
{

struct placed_triangles
{
    mesh<triangle> places;
    double unit;                                   ///< unit_scale(places)
    std::vector<idx> origins;                      ///< triangles of the input
    std::span<const std::array<idx, 3>> triangles; ///< all of the input; corners keep their places
    std::span<const idx> polygons = {};            ///< polygon of each triangle of the input; or empty

    /// The corners of a triangle, times unit.
    std::array<vec3, 3> rest(idx cell) const { return scaled_rest(places, cell, unit); }
    idx place(idx corner) const { return places.cells()[static_cast<std::size_t>(corner / 3)][slot(corner)]; }
    /// The vertex of the input.
    idx vertex(idx corner) const
    {
        return triangles[static_cast<std::size_t>(origins[static_cast<std::size_t>(corner / 3)])][slot(corner)];
    }
    /// The corners where a side starts and ends.
    static std::array<idx, 2> ends(idx side)
    {
        const idx first = side - side % 3;
        return {first + (side + 1) % 3, first + (side + 2) % 3};
    }
    /// The edge of the input that a side lies on.
    std::array<idx, 2> edge(idx side) const
    {
        const auto [a, b] = ends(side);
        return {std::min(vertex(a), vertex(b)), std::max(vertex(a), vertex(b))};
    }
    /// Returns whether two sides are of one polygon: its diagonal, if they are of one edge.
    bool together(idx side, idx other) const
    {
        const auto polygon = [this](idx s)
        { return polygons[static_cast<std::size_t>(origins[static_cast<std::size_t>(s / 3)])]; };
        return !polygons.empty() && polygon(side) == polygon(other);
    }
    /// Returns whether two sides of one edge run the same way.
    bool clash(idx side, idx other) const { return place(ends(side)[0]) == place(ends(other)[0]); }

private:
    static std::size_t slot(idx corner) { return static_cast<std::size_t>(corner % 3); }
};

/// Brings triangles to their places. cells: of the input, each with three places. place: a vertex for each vertex
inline placed_triangles place_triangles(std::span<const vec3> points, std::span<const std::array<idx, 3>> triangles,
                                        std::vector<idx> cells, std::span<const idx> place)
{
    std::vector<idx> number(points.size(), -1);
    std::vector<std::array<idx, 3>> placed;
    placed.reserve(cells.size());
    for (const idx c : cells)
    {
        auto t = triangles[static_cast<std::size_t>(c)];
        for (idx& v : t) number[static_cast<std::size_t>(v = place[static_cast<std::size_t>(v)])] = 0;
        placed.push_back(t);
    }
    std::vector<vec3> used;
    for (std::size_t v = 0; v < number.size(); ++v)
    {
        if (number[v] < 0) continue;
        number[v] = static_cast<idx>(used.size());
        used.push_back(points[v]);
    }
    for (auto& t : placed)
        for (idx& v : t) v = number[static_cast<std::size_t>(v)];
    mesh<triangle> places(std::move(used), std::move(placed));
    const double unit = unit_scale(places);
    return {std::move(places), unit, std::move(cells), triangles, {}};
}

/// Moves the cells that `is_bad` names to a list, in the numbering of the input.
template <class IsBad>
std::vector<idx> take_out(std::vector<idx>& cells, IsBad is_bad)
{
    std::vector<idx> out;
    std::erase_if(cells,
                  [&](idx c)
                  {
                      const bool bad = is_bad(c);
                      if (bad) out.push_back(c);
                      return bad;
                  });
    return out;
}

/// Pairs of triangles of the input, of which the first stays: those at the same places that face the same way, and
/// those with the same vertices. f: facets of t.places
inline std::vector<idx> copies(const placed_triangles& t, const facet_table& f)
{
    std::vector<idx> some = duplicate_cells(t.places, f);
    std::sort(some.begin(), some.end());
    some.erase(std::unique(some.begin(), some.end()), some.end());
    struct candidate
    {
        std::array<idx, 3> places, vertices; // sorted
        idx cell;
        bool odd; // what sorting the places took
    };
    std::vector<candidate> sorted;
    for (const idx c : some)
    {
        candidate x{t.places.cells()[static_cast<std::size_t>(c)], {}, c, false};
        for (std::size_t k = 0; k < 3; ++k) x.vertices[k] = t.vertex(3 * c + static_cast<idx>(k));
        for (const auto& [i, j] : {std::pair(0U, 1U), std::pair(1U, 2U), std::pair(0U, 1U)})
            if (x.places[i] > x.places[j])
            {
                std::swap(x.places[i], x.places[j]);
                x.odd = !x.odd;
            }
        std::sort(x.vertices.begin(), x.vertices.end());
        sorted.push_back(x);
    }
    std::sort(sorted.begin(), sorted.end(),
              [](const candidate& a, const candidate& b)
              { return a.places != b.places ? a.places < b.places : a.cell < b.cell; });

    std::vector<std::pair<idx, idx>> pairs;
    std::vector<candidate> kept; // at one place: one that faces each way, at most
    for (const candidate& x : sorted)
    {
        if (!kept.empty() && kept[0].places != x.places) kept.clear();
        const auto same = std::find_if(kept.begin(), kept.end(),
                                       [&](const candidate& k) { return k.odd == x.odd || k.vertices == x.vertices; });
        const auto origin = [&](const candidate& k) { return t.origins[static_cast<std::size_t>(k.cell)]; };
        if (same == kept.end())
            kept.push_back(x);
        else
            pairs.emplace_back(origin(*same), origin(x));
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<idx> ids;
    for (const auto& [first, second] : pairs) ids.insert(ids.end(), {first, second});
    return ids;
}

} // namespace taut::impl
