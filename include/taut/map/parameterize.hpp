// SPDX-License-Identifier: MIT
#pragma once

#include <taut/compute/queue.hpp>
#include <taut/map/map_result.hpp>
#include <taut/map/parameterize_params.hpp>
#include <taut/map/separate.hpp>
#include <taut/mesh/mesh.hpp>

#ifndef TAUT_SEPARATE
#include <taut/map/parameterization.hpp>
#endif

namespace taut
{

/// Maps a surface to the plane with as little distortion as the energy asks for and without flipping a triangle:
/// validate -> start map -> minimise on the queue's device -> certificate in exact arithmetic.
///
/// The map comes in the user's vertex order and in the units of the surface; a scale-invariant energy leaves the scale
/// open, and the map then has the area of the surface. On a stop for any reason (limits, observer) the map is the best
/// one so far, which is as valid as any.
/// Throws mesh_error (not a disk, degenerate triangle, ...), parameter_error, device_error.
TAUT_INLINE map_result parameterize(queue& q, const mesh<triangle>& m, const parameterize_params& params = {});

} // namespace taut
