// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/objective/volume_objective.hpp>
#include <taut/impl/untangle/untangle_declared.hpp>
#include <taut/impl/untangle/untangle_on_device.hpp>

template taut::untangle_result<taut::tetrahedron> taut::untangle(const queue&, const untangle_problem<tetrahedron>&,
                                                                 const untangle_params&, const run_limits&);
