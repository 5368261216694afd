// SPDX-License-Identifier: MIT
#pragma once

#include <taut/solve_params.hpp>

namespace taut::solve::impl
{

/// Returns whether a run ended near a minimum rather than by a limit, a failure or a request.
constexpr bool converged(stop reason) noexcept
{
    return reason == stop::gradient || reason == stop::decrement || reason == stop::settled ||
           reason == stop::decrease || reason == stop::step;
}

} // namespace taut::solve::impl
