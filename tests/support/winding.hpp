// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <taut/impl/core/mesh/boundary.hpp>
#include <taut/mesh.hpp>

namespace taut::test
{

/// Inner vertices whose angles in a map add up to more than one turn, ascending: the oracle for branch points, which
/// the library finds without angles.
inline std::vector<idx> wound_vertices(const mesh<triangle>& m, const std::vector<vec2>& uv)
{
    const auto boundary = impl::boundary_flags(uv.size(), boundary_loops(m));
    std::vector<double> angle(uv.size(), 0.0);
    for (const auto& t : m.cells())
        for (std::size_t k = 0; k < 3; ++k)
        {
            const auto at = [&](std::size_t i) { return uv[static_cast<std::size_t>(t[(k + i) % 3])]; };
            const vec2 a = at(1) - at(0), b = at(2) - at(0);
            angle[static_cast<std::size_t>(t[k])] += std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b));
        }
    std::vector<idx> found;
    for (std::size_t v = 0; v < uv.size(); ++v)
        if (boundary[v] == 0 && angle[v] > 3 * std::numbers::pi) found.push_back(static_cast<idx>(v));
    return found;
}

} // namespace taut::test
