// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include <taut/impl/core/mesh/facets.hpp>
#include <taut/mesh.hpp>
#include <taut/paste.hpp>

namespace taut::impl
{

/// Halves the edges inside a region that join two vertices of its rim, with a vertex that is none of the whole surface
/// (-1). Without them no triangle has rim vertices only, which a pinned rim may flip, and no edge is duplicated by
/// another filling of the rim.
inline surface_region split_chords(surface_region region)
{
    using edge = std::array<idx, 2>;
    std::vector<char> on_rim(region.surface.points().size(), 0);
    for (const idx v : region.rim) on_rim[static_cast<std::size_t>(v)] = 1;
    const auto sides = facets(region.surface);
    auto points = region.surface.points();
    std::map<edge, idx> middles;
    const auto sorted = [](idx a, idx b) { return a < b ? edge{a, b} : edge{b, a}; };
    for (std::size_t s = 0; s < sides.twin.size(); ++s)
    {
        if (sides.twin[s] == facet_table::boundary) continue;
        const auto [a, b] = side_vertices(region.surface, static_cast<idx>(s));
        if (!on_rim[static_cast<std::size_t>(a)] || !on_rim[static_cast<std::size_t>(b)]) continue;
        if (!middles.emplace(sorted(a, b), static_cast<idx>(points.size())).second) continue;
        points.push_back(0.5 * (points[static_cast<std::size_t>(a)] + points[static_cast<std::size_t>(b)]));
        region.vertices.push_back(-1);
    }
    if (middles.empty()) return region;

    std::vector<mesh<triangle>::cell> cells;
    std::vector<idx> faces;
    for (std::size_t f = 0; f < region.faces.size(); ++f)
    {
        std::vector<idx> polygon; // the triangle with the middles of its sides
        std::size_t first_middle = 6;
        const auto& t = region.surface.cells()[f];
        for (std::size_t k = 0; k < 3; ++k)
        {
            polygon.push_back(t[k]);
            const auto middle = middles.find(sorted(t[k], t[(k + 1) % 3]));
            if (middle == middles.end()) continue;
            first_middle = polygon.size();
            polygon.push_back(middle->second);
        }
        const std::size_t n = polygon.size();
        const auto at = [&](std::size_t i) { return polygon[(first_middle + i) % n]; };
        if (n == 6) // all three: the corners, then what is left
        {
            for (std::size_t i = 0; i < 6; i += 2) cells.push_back({at(i), at(i + 1), at(i + 2)});
            cells.push_back({at(0), at(2), at(4)});
        }
        else
            for (std::size_t i = 1; i + 1 < n; ++i) cells.push_back({at(0), at(i), at(i + 1)}); // a fan from a middle
        faces.insert(faces.end(), cells.size() - faces.size(), region.faces[f]);
    }
    region.faces = std::move(faces);
    region.surface = mesh<triangle>(std::move(points), std::move(cells));
    return region;
}

} // namespace taut::impl
