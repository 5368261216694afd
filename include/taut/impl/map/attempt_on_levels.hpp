// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <taut/impl/core/made_ahead.hpp>
#include <taut/impl/map/attempt_on_mesh.hpp>
#include <taut/impl/start/nested.hpp>

namespace taut::impl
{

/// Parameters of the start and of the minimisation on coarser levels.
inline nested_params descent_of(const map_run& run)
{
    nested_params p;
    if (!run.iterates()) p.stopping.max_iterations = 0;
    p.start.boundary = run.params.barycentric.boundary;
    p.start.fixed_boundary = run.params.boundary == boundary_mode::fixed;
    p.start.proceed = [&run] { return run.clock.proceed(); };
    return p;
}

/// Attempts a minimisation with a hierarchy, `levels`. from: initial map, as attempt::arrival; none: the start.
inline attempt attempt_on(const mesh_levels<triangle>& levels, const nested_params& descent, const map_run& run,
                          const run_start& start, precision how, int max_iterations, std::vector<vec2> from)
{
    const auto& numbers = levels.order().vertices;
    attempt a;
    a.precision = how;
    a.arrival = std::move(from);
    if (a.arrival.empty() && !start.coarse) a.arrival = numbers.apply(centred(start.map.uv, start.centre));
    const bool descends = a.arrival.empty();
    const std::size_t first = descends ? descent.first_level(levels) : 0;
    // Plans are made while the driver compiles, and while coarser levels are solved.
    using plan = typename level_solver<triangle>::plan;
    const auto form = lane_form::for_device(run.queue.device());
    made_ahead<plan> plans(first + 1, [&](std::size_t k) { return plan(levels, first - k, form); });
    const auto take = [&](std::size_t l) { return plans.take(first - l); };

    std::optional<level_solver<triangle>> solver;
    const bool built =
        build_within(run.queue, run.clock,
                     [&]
                     {
                         solver.emplace(run.queue, levels, run.params.energy, run.params.weights, types_of(how));
                         solver->warm_up();
                     });
    if (built) run.clock.spent(&map_seconds::device);
    run.clock.stages.add({.stage = "device", .vertices = run.vertices()});
    a.stopped = !built || !run.clock.proceed();
    if (a.stopped) return a;
    if (descends)
    {
        nested_iteration nested(levels, *solver, descent);
        a.arrival = nested.run([&run](std::size_t l) { return observer_on(run.clock, l); }, take);
        run.clock.stages.append(nested.stages());
        a.descent = {nested.start(), nested.reports(),
                     a.arrival.empty() ? nested.reason() : "the map that came of it could not be certified"};
        a.hard = nested.hard();
        run.clock.spent(&map_seconds::start);
        if (!a.arrival.empty()) run.clock.has_result(true);
        a.stopped = a.arrival.empty() ? run.clock.over() : !run.clock.proceed();
        if (a.stopped || a.arrival.empty()) return a;
    }
    typename level_solver<triangle>::level finest(*solver, take(0), a.arrival,
                                                  run.held.beyond_pins(start.centre).renumbered(numbers));
    run.clock.spent(&map_seconds::setup);
    a.stopped = !run.clock.proceed();
    if (a.stopped) return a;
    if (start.coarse && run.iterates()) finest.relax();
    run.clock.stages.add({.stage = "prepare", .vertices = run.vertices()});
    a.solve = finest.minimize(limited(run, max_iterations),
                              observer_of(run, start, [&] { return numbers.undo(finest.download()); }));
    for (int& c : a.solve.capping) c = levels.order().cells.new_to_old[static_cast<std::size_t>(c)];
    run.clock.stages.add(minimised_on_mesh(run, a.solve));
    const auto begin = start.coarse ? numbers.undo(a.arrival) : start.map.uv;
    a.arrival = finest.download();
    a.uv = restored(run, numbers.undo(a.arrival), start.centre, begin);
    run.clock.spent(&map_seconds::solve);
    return certified(run.in, std::move(a));
}

/// Attempts a minimisation with the hierarchy of the run, or, on slow convergence and if the time limit allows it, with
/// one of a smaller coarsening ratio, which takes longer.
inline attempt attempt_on_levels(const map_run& run, const run_start& start, precision how, int max_iterations,
                                 const std::vector<vec2>& from)
{
    nested_params descent = descent_of(run);
    if (run.vertices() >= nested_params::hard_vertices) descent.hard_from = 10; // others take 3 to 8
    attempt a = attempt_on(*run.levels, descent, run, start, how, max_iterations, from);
    if (!a.hard || a.stopped) return a;
    constexpr double room = 8; // times what the run has taken so far; the slower descent takes about three
    descent.hard_from = 0;
    if (run.clock.left().count() < room * run.clock.total())
        return attempt_on(*run.levels, descent, run, start, how, max_iterations, from);
    return attempt_on(run.make_levels(nested_params::patient_factor), descent.patient(), run, start, how,
                      max_iterations, from);
}

} // namespace taut::impl
