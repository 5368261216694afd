// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include <taut/mesh/mesh.hpp>
#include <taut/mesh/triangle.hpp>

namespace taut::detail
{

/// A power of two that brings a surface near the size 1 if areas, or products of them, would be no numbers; else 1.
inline double unit_of(const mesh<triangle>& m)
{
    double extent = 0;
    for (const vec3& p : m.points()) extent = std::max({extent, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (extent == 0 || (extent > 1e-70 && extent < 1e70)) return 1;
    return std::ldexp(1.0, std::clamp(-std::ilogb(extent), -1000, 1000));
}

/// The same with lengths times a power of two.
inline mesh<triangle> times(const mesh<triangle>& m, double unit)
{
    auto points = m.points();
    for (vec3& p : points) p *= unit;
    return {std::move(points), m.cells()};
}

} // namespace taut::detail
