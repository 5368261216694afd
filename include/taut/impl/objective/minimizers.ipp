// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/objective/minimizers.hpp>

namespace taut::solve
{

template report minimize(taut::impl::newton_objective<triangle>&, taut::impl::newton_objective<triangle>::point&,
                         const params&, const run_limits&);
template class impl::prescribed_newton<taut::impl::newton_objective<triangle>>;

} // namespace taut::solve
