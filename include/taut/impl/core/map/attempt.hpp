// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/map/made_ahead.hpp>
#include <taut/impl/core/map/map_run.hpp>
#include <taut/impl/core/map/run_start.hpp>
#include <taut/impl/core/objective/map_objective.hpp>
#include <taut/impl/core/solve/report.hpp>
#include <taut/impl/core/start/nested.hpp>
#include <taut/minimize.hpp>

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

/// Calls build, which may take seconds in the driver, and checks the limits between kernels; returns false if they
/// ended it.
template <class Build>
bool build_within(const queue& q, run_clock& clock, const Build& build)
{
    struct stopped
    {
    };
    struct question
    {
        queue_state& state;
        ~question() { state.commands->between_builds = nullptr; }
    };
    const question asked{*state_of(q)};
    asked.state.commands->between_builds = [&clock]
    {
        if (!clock.proceed()) throw stopped();
    };
    try
    {
        build();
    }
    catch (const stopped&)
    {
        return false;
    }
    return true;
}

/// Wraps the user's observer for a coarser level, with the time limit.
inline taut::observer observer_on(run_clock& clock, std::size_t level)
{
    return [&clock, level](progress p)
    {
        p.level = static_cast<int>(level);
        return clock.proceed(p);
    };
}

/// Wraps the user's observer for the finest level. now: the map of the run, centred, in the user's order.
inline taut::observer observer_of(const map_run& run, const run_start& start, std::function<std::vector<vec2>()> now)
{
    return [&run, &start, now = std::move(now)](progress p)
    {
        p.coordinates = [&run, &start, &now]
        {
            auto uv = now();
            for (vec2& point : uv) point = (point + start.centre) / run.in.unit;
            run.held.impose(uv, 1);
            return uv;
        };
        return run.clock.ask(p);
    };
}

/// Solver parameters for the finest level.
inline solve::params limited(const map_run& run, int max_iterations)
{
    auto p = run.params.solve;
    if (p.tuning.stopping.base == 0)
        p.tuning.stopping.base = energy::rest_value<triangle::dimension>(run.params.energy);
    p.max_iterations = max_iterations;
    return p;
}

/// The rest of the time, and the observer of observer_of().
inline run_limits limits_of(const map_run& run, const run_start& start, std::function<std::vector<vec2>()> now)
{
    return {run.clock.left(), observer_of(run, start, std::move(now))};
}

inline std::vector<vec2> centred(std::vector<vec2> uv, const vec2& centre)
{
    for (vec2& p : uv) p -= centre;
    return uv;
}

/// Stage report of a minimisation on the finest level; capping in the user's numbering.
inline stage_report minimised_on_mesh(const map_run& run, const solve::report& r)
{
    stage_report did = stage_of("minimise", 0, run.vertices(), r);
    did.cut_by = corners_of(run.in.surface.cells(), r.capping);
    return did;
}

/// Attempts a minimisation without a hierarchy.
inline attempt attempt_on_mesh(const map_run& run, const run_start& start, precision how, int max_iterations)
{
    attempt a;
    a.precision = how;
    const auto local = std::make_shared<layout<triangle>>(run.in.surface, run.held.marks().pinned());
    const auto& data = run.params.data;
    if (!data.empty()) local->attach(data.reordered(local->order.cells), permute(run.in.surface, local->order));
    map_objective<triangle> f(run.queue, local, run.params.energy, run.params.weights, types_of(how),
                              run.held.beyond_pins(start.centre));
    auto x = f.make_point();
    f.upload(centred(start.map.uv, start.centre), x);
    run.clock.spent(&map_seconds::setup);
    a.stopped = !build_within(run.queue, run.clock, [&] { f.warm_up(x); });
    if (a.stopped) return a;
    run.clock.spent(&map_seconds::device);
    run.clock.stages.add({.stage = "device", .vertices = run.vertices()});
    a.solve = solve::minimize(f, x, limited(run, max_iterations), limits_of(run, start, [&] { return f.download(x); }));
    run.clock.stages.add(minimised_on_mesh(run, a.solve));
    a.uv = restored(run, f.download(x), start.centre, start.map.uv);
    run.clock.spent(&map_seconds::solve);
    return certified(run.in, std::move(a));
}

/// Parameters of the start and of the minimisation on coarser levels.
inline nested_params descent_of(const map_run& run)
{
    nested_params p;
    if (!run.iterates()) p.solve.max_iterations = 0;
    p.start.boundary = run.params.barycentric().boundary;
    p.start.fixed_boundary = run.params.boundary != boundary_mode::free;
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
                              limits_of(run, start, [&] { return numbers.undo(finest.download()); }));
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
    const auto& asked = run.params.solve;
    const bool chosen = run.params.precision == precision::automatic;
    const precision how = run.first_precision();
    attempt first = once(how, asked.max_iterations, {});
    if (first.certified && (!chosen || accurate(first.solve, asked.gradient_tolerance))) return first;
    if (first.stopped || how == precision::fp64 || !run.queue.device().has_fp64()) return first;

    const int left = asked.max_iterations - first.solve.iterations;
    if (first.certified && left == 0) return first;
    attempt next =
        first.certified ? once(precision::fp64, left, first.arrival) : once(precision::fp64, asked.max_iterations, {});
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
