// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/compute/queue.hpp>
#include <taut/impl/core/observer.hpp>
#include <taut/impl/map/map_result.hpp>
#include <taut/impl/map/parameterize_params.hpp>
#include <taut/impl/mesh/mesh.hpp>

namespace taut
{

/// Maps a surface to the plane with as little distortion as the energy asks for and without flipping a triangle:
/// validate -> start map -> minimise on the queue's device -> certificate in exact arithmetic.
///
/// The map comes in the user's vertex order and in the units of the surface; a scale-invariant energy leaves the scale
/// open, and the map then has the area of the surface. An unconstrained map is placed by `placement`. On a stop for any
/// reason (limits, observer) the map is the best one so far, which is as valid as any, or there is none yet
/// (outcome::stopped).
/// Throws mesh_error (not a disk, degenerate triangle, ...), parameter_error, device_error.
map_result parameterize(queue& q, const mesh<triangle>& m, const parameterize_params& params = {},
                        const run_limits& limits = {});

} // namespace taut

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/map/parameterize.ipp>
#endif
