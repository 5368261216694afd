// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <taut/impl/map/map_run.hpp>
#include <taut/impl/map/run_start.hpp>
#include <taut/impl/measure/planar_size.hpp>
#include <taut/impl/untangle/untangle_declared.hpp>

namespace taut::impl
{

/// Untangles a start with flips, or says why that failed. draft: initial guess, the start before pinned vertices were
/// moved to their targets, or none.
inline run_start untangled_start(const map_run& run, run_start start, std::vector<vec2> draft)
{
    const bool bound = run.held.constrained() || run.params.boundary == boundary_mode::fixed;
    run.clock.has_result(bound); // the best map, even with defects
    auto how = run.params.untangling;
    how.limits.time_limit = run.clock.left();
    how.limits.observer = [&run](const progress&) { return run.clock.ask({.iterate = false}); };
    auto problem = run.held.problem(run.in.surface, start.map.uv);
    if (!draft.empty() && certify<2>(run.in.surface.cells(), draft)) problem.draft = std::move(draft);
    auto found = untangle(run.queue, problem, how);

    run.clock.stages.append(found.stages);
    start.untangling = std::move(found.stages);
    const std::string before = "the start had " + describe_defects<triangle>(start.map.flips) + "; ";
    if (!bound && !found)
    {
        start.notes.push_back(before + "another start was made");
        start.useless = true;
        return start;
    }
    start.notes.push_back(before + (found ? "it was untangled" : "untangling failed"));
    start.map.uv = std::move(found.map);
    start.map.assess(run.in.surface, run.in.ideal);
    if (!found)
    {
        const bool proved = found.outcome == untangle_outcome::infeasible;
        start.refused = {proved ? outcome::infeasible : outcome::gave_up, std::move(found.reason),
                         std::move(found.ids)};
    }
    else if (!start.map.flips)
        start.refused = refuse(outcome::no_valid_start, "the start map", start.map.flips);
    return start;
}

/// Computes an injective start on the finest level that satisfies the constraints, or says why there is none. start:
/// its map is any. given: it is made of the user's coordinates.
inline run_start fitted_start(const map_run& run, run_start start, bool given)
{
    auto& uv = start.map.uv;
    std::vector<vec2> draft;
    if (run.held.constrained())
    {
        run.held.bring_near(uv);
        start.pin_origins = run.held.pinned_points(uv);
        draft = uv;
        run.held.impose(uv, run.in.unit);
        start.map.assess(run.in.surface, run.in.ideal);
    }
    run.clock.spent(&map_seconds::start);
    run.clock.stages.add({.stage = "start", .vertices = run.vertices()});
    if (!start.map.flips)
    {
        if (run.held.constrained() || given)
        {
            start = untangled_start(run, std::move(start), std::move(draft));
            run.clock.spent(&map_seconds::untangle);
        }
        else
            start.refused = refuse(outcome::no_valid_start, "the start map", start.map.flips);
        if (!start.ready()) return start;
    }
    if (run.held.constrained() || given) start.centre = bounding_square(uv).centre;
    run.clock.has_result(true);
    start.stopped = !run.clock.proceed();
    return start;
}

} // namespace taut::impl

// A program that maps surfaces alone does without the bodies for tetrahedra.
#ifdef TAUT_IMPLEMENTATION
#include <taut/impl/untangle/untangle_triangle.ipp>
#endif
