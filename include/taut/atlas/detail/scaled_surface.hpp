// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include <taut/mesh/mesh.hpp>
#include <taut/mesh/triangle.hpp>

namespace taut::detail
{

/// A surface with lengths times a power of two.
inline mesh<triangle> times(const mesh<triangle>& m, double unit)
{
    auto points = m.points();
    for (vec3& p : points) p *= unit;
    return {std::move(points), m.cells()};
}

} // namespace taut::detail
