// SPDX-License-Identifier: MIT
#pragma once

namespace taut
{

/// Placement of a map with a free boundary and no constraints, which is unique up to rigid motions only.
enum class placement
{
    upright,     ///< in the units of the surface, y up or x to the right, the lower left corner of its box at (0, 0)
    unit_square, ///< the same, scaled to the square [0, 1]^2, of which its box takes a whole side
    as_solved    ///< as left by the solver: near `initial`, or anywhere
};

} // namespace taut
