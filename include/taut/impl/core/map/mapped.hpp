// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/map/run_clock.hpp>
#include <taut/impl/core/map/run_surface.hpp>
#include <taut/parameterize.hpp>
#include <taut/queue.hpp>

namespace taut::impl
{

/// Does all of parameterize() except the counters. params: validated.
map_result mapped(const queue& q, const run_surface& surface, const parameterize_params& params, run_clock& clock);

} // namespace taut::impl
