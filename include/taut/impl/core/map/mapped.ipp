// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/map/mapped.hpp>

#include <taut/impl/core/map/made_convex.hpp>
#include <taut/impl/core/map/overlap/keep_apart.hpp>
#include <taut/impl/core/map/run_result.hpp>
#include <taut/impl/core/map/starts.hpp>

namespace taut::impl
{

inline map_result solved(const map_run& run);

/// Start on the finest level that replaces one from coarser levels whose map could not be certified.
inline run_start second_start(const map_run& run, const run_start& coarse, const attempt& failed)
{
    run_start start = make_start(run, solved, on_the_mesh);
    std::vector<std::string> notes = coarse.notes;
    notes.insert(notes.end(), failed.notes.begin(), failed.notes.end());
    notes.push_back("the coarse start failed (" + failed.descent->failure + "); a barycentric start was made");
    start.notes.insert(start.notes.begin(), notes.begin(), notes.end());
    start.levels = failed.descent->levels;
    if (start.untangling.empty()) start.untangling = coarse.untangling;
    return start;
}

/// Runs the phases between preparation and placement of the map: start, attempts to minimise it, certificate.
/// The map is in normalised units.
inline map_result solved(const map_run& run)
{
    const run_start start = make_start(run, solved);
    if (!start.ready()) return unsolved_result(run, start);
    attempt first = attempt_in_turns(run, start);
    if (first.certified || first.stopped || !start.coarse) return solved_result(run, start, std::move(first));

    run.clock.has_result(false);
    if (!run.clock.proceed()) return stopped_result(run, start, std::move(first));
    const run_start second = second_start(run, start, first);
    if (!second.ready()) return unsolved_result(run, second);
    return solved_result(run, second, attempt_in_turns(run, second));
}

/// The initial map as it is.
inline map_result unchanged(const map_run& run)
{
    run_start start;
    start.map = given_map(run.in.surface, run.in.ideal, run.params, run.in.unit, start.notes);
    attempt none;
    none.uv = start.map.uv;
    none.solve.value = start.map.distortion.measure;
    return solved_result(run, start, certified(run.in, std::move(none)));
}

map_result mapped(const queue& q, const run_surface& surface, const parameterize_params& params, run_clock& clock)
{
    const map_run run(q, surface, params, clock);
    auto proof = params.no_overlap ? refuse_meeting_pins(surface.surface, params.constraints) : std::nullopt;
    map_result found = proof ? refused({}, std::move(*proof)) : run.on_host() ? unchanged(run) : solved(run);
    if (params.no_overlap) found = kept_apart(run, std::move(found));
    found = made_convex(run, std::move(found));
    map_result result = in_user_units(run, placed(run, std::move(found)));
    tell_concave(run, result);
    if (params.no_overlap) result = certified_apart(run, std::move(result));
    clock.stages.add({.stage = "certify", .vertices = run.vertices()});
    result.report.stages = clock.stages.stages();
    return result;
}

} // namespace taut::impl
