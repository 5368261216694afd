// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cmath>
#include <limits>
#include <ostream>
#include <string_view>

#include <taut/errors.hpp>
#include <taut/impl/core/core/name_in.hpp>
#include <taut/options.hpp>

namespace taut
{

/// Step length schedules of the untangling operator.
enum class operator_schedule
{
    literal, ///< by half at every increase, as Algorithm 2 is printed; soon stands still (docs/explanation/numerics.md)
    patience, ///< by half after several increases in a row; a decrease ends the row
    constant  ///< never
};

/// Parameters of untangle_operator. Lengths are relative to the map: the operator works in units in which the mean
/// |det| of the start is 1.
struct operator_params
{
    operator_schedule schedule = operator_schedule::patience;

    /// Length of the first step, and of all with the constant schedule, which works best with 0.1 to 0.2. Range > 0.
    double delta = 0.5;
    /// Increases in a row before the step is halved, with schedule `patience`. Range >= 1.
    int patience = 10;
    /// The run ends where delta falls below it. Range >= 0.
    double least_delta = 1e-6;

    /// Elements with |det| below this are sheared back, the more the closer they are to flat (eq. 26); in units of the
    /// mean |det|. Little depends on it. Range > 0.
    double beta = 0.1;
    /// Weight of the shear operator against the area operator (Fig. 10); 0 leaves it out. Range >= 0.
    double shear = 0.3;
    /// Lower bound that det of every element is to exceed, in units of the mean |det|. A margin keeps the result from
    /// being barely injective, and costs some of the hard problems. Elements are moved a little beyond it, for the
    /// rounding to single precision. Range >= 0.
    double margin = 0;

    /// Maximum number of moves. Range >= 0.
    int iterations = 20000;
    /// Maximum number of iterations enqueued between two checks of the state, by which limits and cancellation are
    /// delayed. Range >= 1.
    int batch = 32;
    std::chrono::duration<double> time_limit{std::numeric_limits<double>::infinity()}; ///< range >= 0

    /// Callback after each batch; returning false ends the run. iteration, value (sum of |det| over the inverted
    /// elements, in units of the mean), step (delta) and seconds are set.
    taut::observer observer;

    /// Throws parameter_error.
    void validate() const
    {
        require(delta > 0 && std::isfinite(delta), "delta", "must be positive and finite");
        require(patience >= 1, "patience", "must be at least 1");
        require(least_delta >= 0 && std::isfinite(least_delta), "least_delta", "must be finite and not negative");
        require(beta > 0 && std::isfinite(beta), "beta", "must be positive and finite");
        require(shear >= 0 && std::isfinite(shear), "shear", "must be finite and not negative");
        require(margin >= 0 && std::isfinite(margin), "margin", "must be finite and not negative");
        require(iterations >= 0, "iterations", "must not be negative");
        require(batch >= 1, "batch", "must be at least 1");
        require(time_limit.count() >= 0, "time_limit", "must not be negative");
    }

    /// Increases in a row before delta is halved; 0: never.
    int increases() const
    {
        return schedule == operator_schedule::literal ? 1 : schedule == operator_schedule::patience ? patience : 0;
    }

private:
    static void require(bool good, const char* field, const char* remedy)
    {
        if (!good) throw parameter_error(field, remedy);
    }
};

/// Reasons for the end of a run of the operator; the best map is kept in each case.
enum class operator_stop
{
    untangled,  ///< no element is inverted, in exact arithmetic
    iterations, ///< as many moves as allowed
    step,       ///< delta fell below its limit
    not_finite, ///< the steps were too long and the map grew beyond all bounds
    rounding,   ///< no element is inverted in single precision, but some are in exact arithmetic
    time,       ///< the time limit
    user        ///< the observer said so
};

constexpr std::string_view to_string(operator_stop why) noexcept
{
    return impl::name_in<operator_stop::user>(
        {"untangled", "iterations", "step", "not finite", "rounding", "time", "user"}, why);
}

inline std::ostream& operator<<(std::ostream& stream, operator_stop why)
{
    return stream << to_string(why);
}

} // namespace taut
