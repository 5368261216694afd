// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/map/session/shape_setup.hpp>

namespace taut::impl
{

template session_setup<triangle> shape_setup(const mesh<triangle>&, const deform_params<triangle>&, const run_limits&);

} // namespace taut::impl
