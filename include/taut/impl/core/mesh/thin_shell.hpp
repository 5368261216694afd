// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace taut::impl
{

/// Attributes of a hinge that energy::shell reads.
struct shell_attributes
{
    static constexpr std::size_t first = 0;   ///< W^-1 of triangle (0, 1, 2) in lengths of the common edge: xx, xy, yy
    static constexpr std::size_t second = 3;  ///< the same of triangle (0, 1, 3)
    static constexpr std::size_t shares = 6;  ///< in the areas of its two triangles: area / hinges, by the mean
    static constexpr std::size_t bending = 8; ///< |edge|^2 / (sum of both areas), in means of area and squared edge
    static constexpr std::size_t cosine = 9, sine = 10; ///< cosine and sine of the angle between the normals at rest
    static constexpr std::size_t count = 11;
};

} // namespace taut::impl
