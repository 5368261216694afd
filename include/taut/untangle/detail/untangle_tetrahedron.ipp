// SPDX-License-Identifier: MIT
#pragma once

#include <taut/untangle/detail/untangle_declared.hpp>
#include <taut/untangle/untangle_on_device.hpp>

template taut::untangle_result<taut::tetrahedron> taut::untangle(const queue&, const untangle_problem<tetrahedron>&,
                                                                 const untangle_params&);
