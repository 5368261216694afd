// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <utility>

#include <taut/impl/core/map/attempt.hpp>
#include <taut/impl/core/map/place_map.hpp>
#include <taut/impl/core/solve/monitor.hpp>

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

/// Places an unconstrained map, or leaves it if rounding would flip a triangle. A map with a fixed boundary is only
/// scaled and translated into the unit square.
inline map_result placed(const map_run& run, map_result r)
{
    const bool fits = run.params.placement == placement::unit_square, free = run.is_free();
    if (!r || run.held.constrained() || run.params.placement == placement::as_solved || (!free && !fits)) return r;
    run.in.set_unused_aside(r.uv);
    const double side = fits ? run.in.unit : 0;
    for (const bool turned : {true, false})
    {
        if (turned && !free) continue;
        auto map = in_corner(turned ? turned_up(run.in.surface, r.uv) : r.uv, side);
        const auto flips = certify<2>(run.in.surface.cells(), map.uv, run.in.ideal.measure);
        if (!flips) continue;
        r.uv = std::move(map.uv);
        r.report.scale = map.scale;
        r.report.flips = flips;
        return r;
    }
    r.report.notes.push_back("rounding would flip triangles of the map in its place; it stays where it was solved");
    return r;
}

/// Converts a map to the user's units, pins bit for bit; the division is inexact at the ends of the range of double, so
/// a valid map is certified again.
inline map_result in_user_units(const map_run& run, map_result r)
{
    for (auto* points : {&r.uv, &r.report.start.uv})
        if (!points->empty()) run.in.set_unused_aside(*points);
    for (auto* points : {&r.uv, &r.report.start.uv, &r.report.pin_origins})
        for (vec2& p : *points) p /= run.in.unit;
    if (!r.uv.empty()) run.held.impose(r.uv, 1);
    if (!r) return r;
    r.report.flips.take_defects(certify<2>(run.in.surface.cells(), r.uv));
    if (r.report.flips) return r;
    const auto why = refuse(outcome::gave_up,
                            "the map in the units of the surface, which are too large or small for double "
                            "precision,",
                            r.report.flips);
    return refused(std::move(r), why);
}

} // namespace taut::impl
