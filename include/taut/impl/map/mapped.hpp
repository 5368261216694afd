// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/compute/queue.hpp>
#include <taut/impl/map/map_result.hpp>
#include <taut/impl/map/parameterize_params.hpp>
#include <taut/impl/map/run_clock.hpp>
#include <taut/impl/map/run_surface.hpp>

namespace taut::impl
{

/// Does all of parameterize() except the counters. params: validated.
map_result mapped(const queue& q, const run_surface& surface, const parameterize_params& params, run_clock& clock);

} // namespace taut::impl

#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/map/mapped.ipp>
#endif
