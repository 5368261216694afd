// SPDX-License-Identifier: MIT
#pragma once

#include <taut/start_map.hpp>

namespace taut::impl
{

/// Convex outline of the boundary.
enum class boundary_shape
{
    circle,
    square
};

/// Parameters of the fixed boundary of a barycentric map.
struct boundary_params
{
    boundary_shape shape = boundary_shape::circle;
    boundary_spacing spacing = boundary_spacing::chord;
};

/// Weights that make each free vertex a mean of its neighbours.
///
/// uniform:    1 for every edge (Tutte); symmetric, blind to the surface's shape
/// mean_value: (tan(a/2) + tan(b/2)) / |vi - vj| with the two angles at vi beside the edge (Floater 2003); positive on
///             every non-degenerate surface and reproduces a planar convex mesh exactly, but not symmetric
enum class barycentric_weights
{
    uniform,
    mean_value
};

/// Parameters of a barycentric map onto a convex polygon.
struct barycentric_params
{
    boundary_params boundary = {};
    barycentric_weights weights = barycentric_weights::mean_value;

    /// Maximum number of further solves with weights that reduce stretch, 0 to 20. Each costs about as much as the map
    /// itself; one to three commonly lower the distortion of a deep surface ten to a hundred times. It ends early when
    /// a round gains less than 5 %, and the best map is kept.
    int stretch_rounds = 0;
};

} // namespace taut::impl
