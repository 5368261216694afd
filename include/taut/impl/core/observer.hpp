// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include <taut/impl/core/error.hpp>
#include <taut/impl/core/linalg.hpp>

namespace taut
{

/// Progress of a run.
struct progress
{
    int iteration = 0;           ///< accepted steps so far
    double value = 0;            ///< f at the current iterate
    double gradient = 0;         ///< its relative gradient
    double step = 0;             ///< the last accepted step
    int evaluations = 0;         ///< values computed so far
    double seconds = 0;          ///< since the start
    int level = 0;               ///< level of a nested iteration; 0: the problem itself
    std::string_view stage = {}; ///< of a call of several stages: of make_atlas() "charts", "flatten" or "pack"
    bool iterate =
        true; ///< a new iterate; false: in the middle of a line search, the other fields are the last iterate's
    bool usable = true; ///< a run that ends now has a result; false where one of several phases has none yet
    /// Current map, one point per vertex in the user's order and lengths, for a live view: as valid as the result, but
    /// not certified. Empty where there is no map of the whole surface. A call costs a download; to be called by the
    /// observer only.
    std::function<std::vector<vec2>()> coordinates = {};
    /// Current shape of a volume, in the same way.
    std::function<std::vector<vec3>()> positions = {};
};

/// Callback at every iterate and after every evaluation of a line search. Returning false ends the run with the best
/// iterate so far (solve::stop::user). It runs on the thread of the solver; an exception passes through.
using observer = std::function<bool(const progress&)>;

/// Limits of a run, the same for all entry points. A run that reaches one ends with the best valid result so far, or
/// with none, which its outcome says.
struct run_limits
{
    /// Wall-clock seconds of the whole call. Range >= 0.
    std::chrono::duration<double> time_limit = std::chrono::duration<double>(std::numeric_limits<double>::infinity());

    /// Asked at every iterate and trial step, between phases and between the steps of long ones: false ends the run.
    /// It runs on the thread that called; an exception passes through.
    taut::observer observer = {};

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (!(time_limit.count() >= 0)) throw parameter_error("time_limit", "must not be negative");
    }
};

} // namespace taut
