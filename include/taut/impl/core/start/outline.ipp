// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/start/outline.hpp>

namespace taut::impl
{

std::vector<std::pair<std::size_t, std::size_t>> dividing_edges(const mesh<triangle>& m, const facet_table& f,
                                                                const std::vector<idx>& loop)
{
    std::vector<idx> position(m.points().size(), -1);
    for (std::size_t k = 0; k < loop.size(); ++k) position[static_cast<std::size_t>(loop[k])] = static_cast<idx>(k);
    std::vector<std::pair<std::size_t, std::size_t>> result;
    for (std::size_t side = 0; side < f.twin.size(); ++side)
    {
        if (f.twin[side] < static_cast<idx>(side)) continue; // boundary, or seen from the other side
        const auto [a, b] = side_vertices(m, static_cast<idx>(side));
        const idx p = position[static_cast<std::size_t>(a)];
        const idx q = position[static_cast<std::size_t>(b)];
        if (p >= 0 && q >= 0) result.emplace_back(p, q);
    }
    return result;
}

void span_hole(const std::vector<idx>& loop, std::vector<vec3>& points, std::vector<std::array<idx, 3>>& cells)
{
    const auto at = [&points](idx v) { return points[static_cast<std::size_t>(v)]; };
    vec3 centre(0);
    for (const idx v : loop) centre += at(v) / static_cast<double>(loop.size());
    vec3 normal(0);
    double radius = 0;
    for (std::size_t k = 0; k < loop.size(); ++k)
    {
        normal += glm::cross(at(loop[k]) - centre, at(loop[(k + 1) % loop.size()]) - centre);
        radius = std::max(radius, glm::length(at(loop[k]) - centre));
    }
    if (const double length = glm::length(normal); length > 0) centre += normal * (radius / length);
    const auto apex = static_cast<idx>(points.size());
    points.push_back(centre);
    // The surface is to the left of the loop, so the cone runs along it the other way.
    for (std::size_t k = 0; k < loop.size(); ++k) cells.push_back({loop[(k + 1) % loop.size()], loop[k], apex});
}

} // namespace taut::impl
