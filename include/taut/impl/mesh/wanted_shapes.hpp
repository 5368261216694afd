// SPDX-License-Identifier: MIT
#pragma once

namespace taut
{

/// What elements are wanted to look like.
enum class wanted_shapes
{
    rest,   ///< like the elements at rest
    regular ///< all the same, with equal edges
};

} // namespace taut
