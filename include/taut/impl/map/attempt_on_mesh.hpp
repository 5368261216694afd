// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <taut/impl/energy/element.hpp>
#include <taut/impl/map/attempt.hpp>
#include <taut/impl/objective/map_objective.hpp>
#include <taut/impl/solve/minimize.hpp>

namespace taut::impl
{

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
        ~question() { state.between_builds = nullptr; }
    };
    const question asked{*q.state()};
    asked.state.between_builds = [&clock]
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

/// Solver parameters for the finest level, with the remaining time.
inline solve::params limited(const map_run& run, int max_iterations)
{
    auto p = run.params.solve;
    if (p.stopping.tuning.base == 0)
        p.stopping.tuning.base = energy::rest_value<triangle::dimension>(run.params.energy);
    p.stopping.max_iterations = max_iterations;
    p.stopping.time_limit = std::max(run.clock.left(), std::chrono::duration<double>(1e-9));
    return p;
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
    a.solve =
        solve::minimize(f, x, limited(run, max_iterations), observer_of(run, start, [&] { return f.download(x); }));
    run.clock.stages.add(minimised_on_mesh(run, a.solve));
    a.uv = restored(run, f.download(x), start.centre, start.map.uv);
    run.clock.spent(&map_seconds::solve);
    return certified(run.in, std::move(a));
}

} // namespace taut::impl
