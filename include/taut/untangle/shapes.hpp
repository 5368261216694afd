// SPDX-License-Identifier: MIT
#pragma once

namespace taut
{

/// What the elements are wanted to look like while a stage works.
enum class untangle_shapes
{
    rest,   ///< like the elements at rest
    regular ///< all the same, with equal edges
};

} // namespace taut
