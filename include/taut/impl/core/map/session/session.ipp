// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/map/session/incremental_loading.hpp>
#include <taut/impl/core/map/session/session_run.hpp>
#include <taut/impl/core/map/session/shape_setup.hpp>
#include <taut/impl/core/objective/running_map.hpp>

namespace taut::impl
{

template class incremental_loading<triangle>;
template class session_run<triangle>;
template session_setup<triangle> shape_setup(const mesh<triangle>&, const deform_params<triangle>&, const run_limits&);
template class running_map<triangle>;

} // namespace taut::impl
