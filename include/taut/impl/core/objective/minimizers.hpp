// SPDX-License-Identifier: MIT
#pragma once

/// Minimisation of the energy of surfaces' maps by all methods; volume_objective.hpp has that of volumes.
#include <taut/impl/core/objective/newton_objective.hpp>
#include <taut/impl/core/solve/prescribed.hpp>
#include <taut/minimize.hpp>

namespace taut::solve
{

// Compiled once, with the bodies.
extern template report minimize(taut::impl::newton_objective<triangle>&, taut::impl::newton_objective<triangle>::point&,
                                const params&, const run_limits&);
extern template class impl::prescribed_newton<taut::impl::newton_objective<triangle>>;

} // namespace taut::solve
