// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <taut/impl/core/map/penalty_continuation.hpp>
#include <taut/impl/core/measure/planar_size.hpp>
#include <taut/impl/core/start/conformal.hpp>
#include <taut/untangle.hpp>

namespace taut::impl
{

/// Untangles a start with flips, or says why that failed. draft: initial guess, the start before pinned vertices were
/// moved to their targets, or none.
inline run_start untangled_start(const map_run& run, run_start start, std::vector<vec2> draft)
{
    const bool bound = run.held.constrained() || run.params.boundary != boundary_mode::free;
    run.clock.has_result(bound); // the best map, even with defects
    auto problem = run.held.problem(run.in.surface, start.map.uv);
    if (!draft.empty() && certify<2>(run.in.surface.cells(), draft)) problem.draft = std::move(draft);
    const auto ask = [&run](const progress&) { return run.clock.ask({.iterate = false}); };
    auto found = untangle(run.queue, problem, {}, {run.clock.left(), ask});

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
    assess(start.map, run.in.surface, run.in.ideal);
    if (!found)
    {
        const bool proved = found.outcome == outcome::infeasible;
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
        assess(start.map, run.in.surface, run.in.ideal);
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

/// Runs the phases between preparation and placement of a map.
using map_solver = map_result (*)(const map_run&);

/// Computes the map of a run without the constraints; none if that has no valid one.
inline std::vector<vec2> free_map(const map_run& run, map_solver solve)
{
    auto params = run.params;
    params.constraints = {};
    params.solve.gradient_tolerance = std::max(1e-3, params.solve.gradient_tolerance);
    run_clock clock(run.clock.left(),
                    [&run](progress now)
                    {
                        now.level = std::max(now.level, 1); // it is not the map that was asked for
                        now.coordinates = {};
                        return run.clock.ask(now);
                    });
    const map_run free(run.queue, run.in, params, clock);
    map_result found = solve(free);
    run.clock.stages.append(clock.stages.stages());
    return found ? std::move(found.uv) : std::vector<vec2>();
}

/// Initial map of a run: its makers are tried in their order.
struct start_maker
{
    std::string_view name;
    bool (*applies)(const map_run&);
    run_start (*make)(const map_run&, map_solver); ///< `useless`: the next one is tried
};

/// Injective start that satisfies the constraints from a map that need not; `useless` without one.
inline run_start start_from(const map_run& run, start_map map)
{
    run_start start;
    start.useless = map.uv.empty();
    start.map = std::move(map);
    return start.useless ? start : fitted_start(run, std::move(start), false);
}

/// Start of a long tube with both ends open, where it is one.
inline run_start start_on_rings(const map_run& run)
{
    run_start start;
    start.useless = true;
    const auto loops = boundary_loops(run.in.surface, run.in.sides);
    if (loops.size() < 2) return start;
    auto map = tube_start(run.in.surface, run.in.ideal, loops, descent_of(run).start);
    return map.uv.empty() || !map.flips ? start : start_from(run, std::move(map));
}

/// The makers of initial maps; the last ones make them on the mesh itself.
inline std::span<const start_maker> start_makers()
{
    static constexpr start_maker all[] = {
        {"given", [](const map_run& run) { return !run.params.initial.empty(); },
         [](const map_run& run, map_solver)
         {
             run_start start;
             start.map = given_map(run.in.surface, run.in.ideal, run.params, run.in.unit, start.notes);
             return fitted_start(run, std::move(start), true);
         }},
        {"tube",
         [](const map_run& run)
         { return run.is_free() && run.params.initial.empty() && run.params.start == start_method::automatic; },
         [](const map_run& run, map_solver) { return start_on_rings(run); }},
        {"coarse", [](const map_run& run) { return run.starts_coarse(); },
         [](const map_run&, map_solver)
         {
             run_start start;
             start.coarse = true;
             return start;
         }},
        {"penalty", [](const map_run& run) { return run.uses_continuation(); },
         [](const map_run& run, map_solver) { return penalty_continuation(run).make(); }},
        {"free map",
         [](const map_run& run)
         {
             return run.held.constrained() && run.params.initial.empty() &&
                    run.params.boundary == boundary_mode::free && !run.outline_pinned();
         },
         [](const map_run& run, map_solver solve)
         {
             start_map map;
             map.uv = free_map(run, solve);
             return start_from(run, std::move(map));
         }},
        {"conformal",
         [](const map_run& run)
         { return run.params.start == start_method::conformal && run.params.boundary == boundary_mode::free; },
         [](const map_run& run, map_solver) { return start_from(run, conformal_start(run.in.surface, run.in.sides)); }},
        {"barycentric", [](const map_run&) { return true; },
         [](const map_run& run, map_solver)
         {
             run_start start;
             const auto proceed = [&run] { return run.clock.proceed(); };
             elimination_solver solver;
             solver.proceed = proceed;
             try
             {
                 start.map = barycentric_map(run.in.surface, run.in.sides, run.params.barycentric(), std::move(solver),
                                             proceed);
             }
             catch (const elimination_solver::stopped&)
             {
                 start.stopped = true;
                 return start;
             }
             return fitted_start(run, std::move(start), false);
         }}};
    return all;
}

inline constexpr std::size_t on_the_mesh = 3; ///< the first of these

/// Makes the start of a run by the first of the makers that applies and succeeds.
inline run_start make_start(const map_run& run, map_solver solve, std::size_t first = 0)
{
    run_start start;
    for (const start_maker& maker : start_makers().subspan(first))
    {
        if (!maker.applies(run)) continue;
        start.stopped = !run.clock.proceed();
        if (start.stopped) break;
        run_start made = maker.make(run, solve);
        made.notes.insert(made.notes.begin(), start.notes.begin(), start.notes.end());
        if (made.untangling.empty()) made.untangling = std::move(start.untangling);
        start = std::move(made);
        if (!start.useless || start.stopped) break;
    }
    return start;
}

} // namespace taut::impl

// A program that maps surfaces alone does without the bodies for tetrahedra.
