// SPDX-License-Identifier: MIT
#pragma once

namespace taut
{

/// Treatment of the boundary of a mesh during smoothing.
enum class smooth_boundary
{
    fixed,   ///< nothing
    sliding, ///< move in its own flat parts and along the straight creases between them; what is curved stays
    free     ///< all; the shape changes
};

} // namespace taut
