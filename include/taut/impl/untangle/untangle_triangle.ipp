// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/untangle/untangle_declared.hpp>
#include <taut/impl/untangle/untangle_on_device.hpp>

template taut::untangle_result<taut::triangle> taut::untangle(const queue&, const untangle_problem<triangle>&,
                                                              const untangle_params&, const run_limits&);
