// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include <taut/impl/map/attempt_on_levels.hpp>

namespace taut::impl
{

/// Returns false where the precision of float, not a limit, ended the run above the tolerance.
inline bool accurate(const solve::report& r, double tolerance)
{
    if (r.stop != solve::stop::decrease && r.stop != solve::stop::line_search && r.stop != solve::stop::barrier)
        return true;
    return r.gradient_norm <= tolerance;
}

/// Attempts a minimisation in one precision, and again in double where that failed. The second one starts from a
/// certified map of the first; both share the limit of iterations.
inline attempt attempt_in_turns(const map_run& run, const run_start& start)
{
    const auto once = [&](precision how, int max_iterations, const std::vector<vec2>& from)
    {
        return run.levels ? attempt_on_levels(run, start, how, max_iterations, from)
                          : attempt_on_mesh(run, start, how, max_iterations);
    };
    const auto& stopping = run.params.solve.stopping;
    const bool chosen = run.params.precision == precision::automatic;
    const precision how = run.first_precision();
    attempt first = once(how, stopping.max_iterations, {});
    if (first.certified && (!chosen || accurate(first.solve, stopping.gradient_tolerance))) return first;
    if (first.stopped || how == precision::fp64 || !run.queue.device().has_fp64()) return first;

    const int left = stopping.max_iterations - first.solve.iterations;
    if (first.certified && left == 0) return first;
    attempt next = first.certified ? once(precision::fp64, left, first.arrival)
                                   : once(precision::fp64, stopping.max_iterations, {});
    next.notes.push_back(first.certified ? "float could not reach the tolerance; continued in double"
                                         : "single precision does not suffice for this map; repeated in double");
    if (!next.descent) next.descent = std::move(first.descent);
    if (!next.stopped)
    {
        if (first.certified) next.solve = solve::impl::joined(std::move(first.solve), std::move(next.solve));
        return next;
    }
    // The map of float, if that is one, else what it began with.
    if (!first.certified && !next.arrival.empty()) first.arrival = std::move(next.arrival);
    first.descent = std::move(next.descent);
    first.notes = std::move(next.notes);
    first.stopped = true;
    return first;
}

} // namespace taut::impl
