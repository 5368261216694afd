// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/types.hpp>

namespace taut
{

/// Sliding constraint: a vertex that moves along a line, or in a plane, through its position.
template <int D>
struct slide
{
    idx vertex;
    glm::mat<D, D, double> projection; ///< projection of displacements on the allowed directions: symmetric, P P = P

    /// Makes a slide perpendicular to a direction of any length but 0: in a plane, or in 2D along a line.
    static slide across(idx v, const vec<D>& normal)
    {
        return {v, glm::mat<D, D, double>(1.0) - glm::outerProduct(normal, normal) / glm::dot(normal, normal)};
    }

    /// Makes a slide along a direction of any length but 0.
    static slide along(idx v, const vec<D>& direction)
    {
        return {v, glm::outerProduct(direction, direction) / glm::dot(direction, direction)};
    }
};

} // namespace taut
