// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <taut/impl/map/map_run.hpp>
#include <taut/impl/map/run_start.hpp>
#include <taut/impl/measure/planar_size.hpp>

namespace taut::impl
{

/// Result of computing the start on coarser levels.
struct coarse_descent
{
    start_map start; ///< on its level, without uv
    std::vector<level_report> levels;
    std::string failure; ///< why it is none, or else why what came of it is none
};

/// One minimisation on the finest level, in one precision, with its final map.
struct attempt
{
    taut::precision precision = taut::precision::fp64;
    std::optional<coarse_descent> descent; ///< that began it
    /// Map of the finest level, in its numbering, centred: the initial one, and after the minimisation the final one.
    /// Empty: there are no levels, or it was not reached.
    std::vector<vec2> arrival;
    std::vector<vec2> uv; ///< in the user's order; empty: it did not come so far
    solve::report solve;
    certificate flips;      ///< of uv, exact
    bool certified = false; ///< there are none, and the energy was finite
    bool stopped = false;   ///< the limits ended it outside of the minimisation
    bool hard = false;      ///< the descent ended at a hard level (nested_params::hard_from)
    std::vector<std::string> notes;
};

/// Certifies the map. A map whose energy was never finite is not certified either.
inline attempt certified(const run_surface& in, attempt a)
{
    a.flips = certify<2>(in.surface.cells(), a.uv, in.ideal.measure);
    a.certified = a.flips && a.solve.stop != solve::stop::not_finite_start;
    return a;
}

/// Removes the solver's translation and scale; restores fixed coordinates. start: a map with the right fixed
/// coordinates.
inline std::vector<vec2> restored(const map_run& run, std::vector<vec2> uv, const vec2& centre,
                                  const std::vector<vec2>& start)
{
    if (run.is_free() && is_scale_invariant(run.params.energy)) keep_total_area(run.in.surface, run.in.ideal, uv);
    for (vec2& p : uv) p += centre;
    run.held.restore(uv, start); // the device may hold positions in float
    return uv;
}

} // namespace taut::impl
