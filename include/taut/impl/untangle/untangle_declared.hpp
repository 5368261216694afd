// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/compute/queue.hpp>
#include <taut/impl/constrain/untangle_problem.hpp>
#include <taut/impl/core/observer.hpp>
#include <taut/impl/untangle/params.hpp>
#include <taut/impl/untangle/result.hpp>

namespace taut
{

/// Untangles a map: moves free coordinates until every element is positive, by a sequence of stages
/// (untangle_params::stages). The outcome is injective only with a certificate in exact arithmetic, infeasible only
/// with a proof; a map that was not found to be either comes with the reason and the inverted elements. Fixed
/// coordinates are those of `problem.initial`, bit for bit, in all cases.
///
/// Newton's method runs on the device, except on small planar meshes, and the paper's operator is a further stage. In
/// the plane that one comes last, as the others are more reliable, and in space early; untangle_params::stages gives
/// another order.
/// The observer is told the iteration, the fewest inverted elements so far (value) and seconds.
/// Throws parameter_error for a problem or parameters that are not valid, device_error.
template <class Element>
untangle_result<Element> untangle(const queue& q, const untangle_problem<Element>& problem,
                                  const untangle_params& params = {}, const run_limits& limits = {});

} // namespace taut
