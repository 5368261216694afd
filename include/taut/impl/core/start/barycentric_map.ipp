// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/start/barycentric_map.hpp>

namespace taut::impl
{

template start_map barycentric_map<elimination_solver>(const mesh<triangle>&, const facet_table&,
                                                       const barycentric_params&, elimination_solver,
                                                       const std::function<bool()>&);

} // namespace taut::impl
