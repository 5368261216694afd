// SPDX-License-Identifier: MIT
#pragma once

#include <ostream>
#include <string_view>

#include <taut/impl/core/name_in.hpp>

namespace taut::solve
{

/// Reasons for which a minimisation ends. All of them are results, none is an exception; the best iterate is kept in
/// each case.
enum class stop
{
    gradient,        ///< the relative gradient fell below its tolerance: converged
    decrement,       ///< several Newton decrements in a row below what the tolerance asks for: converged
    settled,         ///< five Newton steps together gained next to nothing of a soft valley: converged
    decrease,        ///< several relative decreases in a row below the tolerance
    step,            ///< several relative steps in a row below the tolerance
    iterations,      ///< as many iterations as allowed
    line_search,     ///< no lower value along the direction, nor along steepest descent: often the limit of rounding
    barrier,         ///< the barrier cuts every step so short that nothing is gained
    time,            ///< the time limit
    user,            ///< the observer said so
    not_finite_start ///< value or gradient at the start is infinite or not a number
};

} // namespace taut::solve

namespace taut::solve::impl
{

/// Returns whether a run ended near a minimum rather than by a limit, a failure or a request.
constexpr bool converged(stop reason) noexcept
{
    return reason == stop::gradient || reason == stop::decrement || reason == stop::settled ||
           reason == stop::decrease || reason == stop::step;
}

} // namespace taut::solve::impl

namespace taut::solve
{

/// Stable name of a reason, for programs.
constexpr std::string_view to_string(stop reason) noexcept
{
    return taut::impl::name_in<stop::not_finite_start>({"gradient", "decrement", "settled", "decrease", "step",
                                                        "iterations", "line search", "barrier", "time", "user",
                                                        "start not finite"},
                                                       reason);
}

inline std::ostream& operator<<(std::ostream& stream, stop reason)
{
    return stream << to_string(reason);
}

} // namespace taut::solve
