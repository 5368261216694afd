// SPDX-License-Identifier: MIT
#pragma once

#include <taut/paste.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

#include <taut/impl/charts/paste/surface/split_chords.hpp>

namespace taut
{

feature::feature(surface_region of) : region(impl::split_chords(std::move(of)))
{
    const auto& rim = region.rim;
    const auto at = [&](std::size_t i) -> const vec3&
    { return region.surface.points()[static_cast<std::size_t>(rim[i % rim.size()])]; };
    double length = 0;
    for (std::size_t i = 0; i < rim.size(); ++i)
    {
        const double edge = glm::distance(at(i), at(i + 1));
        centre += edge / 2 * (at(i) + at(i + 1));
        length += edge;
    }
    centre /= length;
    vec3 area(0.0); // twice the vector area of the rim (Newell)
    for (std::size_t i = 0; i < rim.size(); ++i)
    {
        area += glm::cross(at(i) - centre, at(i + 1) - centre);
        radius = std::max(radius, glm::distance(at(i), centre));
    }
    if (!(glm::length(area) > 1e-6 * length * length))
        throw region_error(
            region_error::flat, {},
            "the rim of the region encloses no area, so that its base has no direction; choose another one");
    normal = glm::normalize(area);
}

} // namespace taut
