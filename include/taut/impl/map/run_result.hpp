// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <utility>
#include <vector>

#include <taut/impl/map/attempt.hpp>
#include <taut/impl/solve/monitor.hpp>

namespace taut::impl
{

/// Report of a start and of the last attempt to minimise it, if there was one, without the outcome.
inline map_result run_result(const map_run& run, const run_start& start, attempt a)
{
    map_result r;
    r.uv = std::move(a.uv);
    map_report& report = r.report;
    report.notes = start.notes;
    report.notes.insert(report.notes.end(), a.notes.begin(), a.notes.end());
    report.precision = a.precision;
    report.start = start.map;
    report.levels = start.levels;
    if (a.descent)
    {
        report.start = std::move(a.descent->start);
        report.levels = std::move(a.descent->levels);
    }
    report.pin_origins = start.pin_origins;
    report.untangling = start.untangling;
    report.flips = std::move(a.flips);
    report.solve = std::move(a.solve);
    report.seconds = run.clock.seconds;
    return r;
}

inline map_result refused(map_result r, refusal why)
{
    r.report.outcome = why.outcome;
    r.report.reason = std::move(why.reason);
    r.report.ids = std::move(why.ids);
    return r;
}

/// Result of a run that the limits ended outside of a minimisation: the best map, if there is one. a: the attempt by
/// then.
inline map_result stopped_result(const map_run& run, const run_start& start, attempt a)
{
    if (!a.certified)
    {
        a.uv = start.map.uv;
        if (start.coarse && !a.arrival.empty()) a.uv = run.levels->order().vertices.undo(a.arrival);
        if (!a.uv.empty())
        {
            a.uv = restored(run, a.uv, vec2(0), a.uv);
            const means e = mean_over<triangle>(run.in.surface, run.in.ideal, a.uv,
                                                [&run](const element<double, 2>& here) {
                                                    return here.det > 0 ? run.params.energy(here)
                                                                        : std::numeric_limits<double>::infinity();
                                                });
            a.solve.value = a.solve.value_start =
                run.params.weights == energy::weighting::measure ? e.measure : e.uniform;
            a = certified(run.in, std::move(a));
        }
    }
    a.solve.stop = solve::impl::stop_of(run.clock);
    const bool valid = a.certified;
    map_result r = run_result(run, start, std::move(a));
    if (valid)
    {
        r.report.outcome = outcome::valid;
        return r;
    }
    r.uv.clear();
    return refused(std::move(r), {outcome::stopped,
                                  run.clock.refused() ? "stopped before there was a map"
                                                      : "the time limit came before there was a map",
                                  {}});
}

/// Result of a start that is not minimised: it is refused, or the limits ended the run.
inline map_result unsolved_result(const map_run& run, const run_start& start)
{
    if (start.stopped) return stopped_result(run, start, {});
    attempt none;
    none.uv = start.map.uv;
    none.flips = start.map.flips;
    return refused(run_result(run, start, std::move(none)), *start.refused);
}

/// Result of the last attempt; where its map is not certified, that of the start, if there is one.
inline map_result solved_result(const map_run& run, const run_start& start, attempt a)
{
    if (a.stopped) return stopped_result(run, start, std::move(a));
    if (!a.certified && !start.map.uv.empty())
    {
        a.notes.push_back("the minimum that was found is too small or too thin for its precision; the start map is "
                          "returned");
        a.uv = start.map.uv;
        a.solve.value = a.solve.value_start;
        a = certified(run.in, std::move(a));
    }
    run.clock.spent(&map_seconds::setup);
    map_result r = run_result(run, start, std::move(a));
    r.report.outcome = outcome::valid;
    if (r.report.flips) return r;
    const auto why = refuse(outcome::no_valid_start, "the map that was found", r.report.flips);
    return refused(std::move(r), why);
}

} // namespace taut::impl
