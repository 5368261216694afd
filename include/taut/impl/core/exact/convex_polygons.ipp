// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/exact/convex_polygons.hpp>

namespace taut::impl
{

bool is_convex(std::span<const idx> loop, std::span<const vec3> points)
{
    constexpr double straight = 1e-6; // sine of the angle
    const std::size_t n = loop.size();
    const auto at = [&](std::size_t k) { return points[static_cast<std::size_t>(loop[k % n])]; };
    vec3 normal(0.0);
    for (std::size_t k = 1; k + 1 < n; ++k) normal += glm::cross(at(k) - at(0), at(k + 1) - at(0));
    const double size = glm::length(normal);
    if (!(size > 0)) return false;
    for (std::size_t k = 0; k < n; ++k)
    {
        const vec3 in = at(k + 1) - at(k), out = at(k + 2) - at(k + 1);
        if (!(glm::dot(glm::cross(in, out), normal) > straight * glm::length(in) * glm::length(out) * size))
            return false;
    }
    return true;
}

convex_polygons find_convex_polygons(std::span<const std::array<idx, 3>> cells, std::span<const idx> polygon,
                                     std::span<const vec3> points)
{
    const auto u = [](idx i) { return static_cast<std::size_t>(i); };
    convex_polygons found;
    if (polygon.empty()) return found;
    found.corners.reserve(2 * cells.size());
    const auto labels = u(*std::max_element(polygon.begin(), polygon.end())) + 1;
    impl::csr members{{}, std::vector<idx>(cells.size())};
    members.offsets = impl::counting_sort(
        cells.size(), labels, [&](std::size_t c) { return polygon[c]; },
        [&](std::size_t c, std::size_t at) { members.items[at] = static_cast<idx>(c); });
    for (std::size_t c = 0; c < cells.size(); ++c) // in the order of their first triangles
    {
        const auto own = members.row(polygon[c]);
        if (own.size() < 2 || u(own.front()) != c) continue;
        const auto loop = impl::outline_of(cells, own);
        if (loop.empty() || !impl::is_convex(loop, points)) continue;
        for (std::size_t k = 0; k < loop.size(); ++k)
            found.corners.push_back({loop[k], loop[(k + 1) % loop.size()], loop[(k + 2) % loop.size()]});
        found.numbers.push_back(polygon[c]);
        found.first.push_back(static_cast<idx>(found.corners.size()));
    }
    return found;
}

std::vector<idx> find_concave(const convex_polygons& polygons, std::span<const vec2> x)
{
    const auto at = [x](idx v) { return x[static_cast<std::size_t>(v)]; };
    std::vector<idx> concave;
    for (idx k = 0; k < polygons.size(); ++k)
    {
        const auto corners = polygons.corners_of(k);
        if (std::any_of(corners.begin(), corners.end(),
                        [&](const auto& c) { return impl::orient2d(at(c[0]), at(c[1]), at(c[2])) <= 0; }))
            concave.push_back(k);
    }
    return concave;
}

} // namespace taut::impl
