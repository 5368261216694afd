// SPDX-License-Identifier: MIT
#pragma once

namespace taut
{

/// Target shapes of elements.
enum class target_shapes
{
    rest,   ///< like the elements at rest
    regular ///< all the same, with equal edges
};

} // namespace taut
