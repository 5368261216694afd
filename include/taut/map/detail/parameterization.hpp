// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <taut/map/detail/attempt_in_turns.hpp>
#include <taut/map/detail/attempt_on_mesh.hpp>
#include <taut/map/detail/choose_start.hpp>
#include <taut/map/detail/overlap/keep_apart.hpp>
#include <taut/map/detail/returned_map.hpp>

namespace taut
{

namespace detail
{

/// What parameterize.hpp declares; include that one.
///
/// The start on the mesh itself that takes the place of one from coarser levels whose map could not be certified.
template <class Element>
run_start second_start(const map_run<Element>& run, const run_start& coarse, const attempt& failed)
{
    run_start start = made_start(run);
    std::vector<std::string> notes = coarse.notes;
    notes.insert(notes.end(), failed.notes.begin(), failed.notes.end());
    notes.push_back("the coarse start failed (" + failed.descent->failure + "); a barycentric start was made");
    start.notes.insert(start.notes.begin(), notes.begin(), notes.end());
    start.levels = failed.descent->levels;
    if (start.untangling.empty()) start.untangling = coarse.untangling;
    return start;
}

/// The phases between a run that is prepared and a map that is placed: start, attempts to minimise it, certificate.
/// The map is in the lengths of the run.
template <class Element>
map_result solved(const map_run<Element>& run)
{
    const run_start start = choose_start(run);
    if (!start.ready()) return unsolved_result(run, start);
    attempt first = attempt_in_turns(run, start);
    if (first.certified || first.stopped || !start.coarse) return solved_result(run, start, std::move(first));

    run.clock.has_result(false);
    if (!run.clock.proceed()) return stopped_result(run, start, std::move(first));
    const run_start second = second_start(run, start, first);
    if (!second.ready()) return unsolved_result(run, second);
    return solved_result(run, second, attempt_in_turns(run, second));
}

// Declared in choose_start.hpp.
template <class Element>
std::vector<vec2> free_draft(const map_run<Element>& run)
{
    auto params = run.params;
    params.constraints = {};
    params.solve.stopping.gradient_tolerance = std::max(1e-3, params.solve.stopping.gradient_tolerance);
    run_clock clock(run.clock.left(),
                    [&run](progress now)
                    {
                        now.level = std::max(now.level, 1); // it is not the map that was asked for
                        now.coordinates = {};
                        return run.clock.ask(now);
                    });
    const map_run<Element> free(run.queue, run.in, params, clock, run.asked);
    map_result draft = solved(free);
    run.clock.stages.append(clock.stages.stages());
    return draft ? std::move(draft.uv) : std::vector<vec2>();
}

template <class Element>
inline constexpr asked_phases<Element> all_phases = {
    .given_start = given_start<Element>,
    .other_start = other_start<Element>,
    .untangled_start = untangled_start<Element>,
    .attempt_on_mesh = attempt_on_mesh<Element>,
    .kept_apart = kept_apart<Element>,
    .certified_apart = certified_apart<Element>,
};

/// All of parameterize() but the counters. params: validated.
template <class Element>
map_result mapped(const queue& q, const run_surface& surface, const parameterize_params& params, run_clock& clock,
                  const asked_phases<Element>* asked)
{
    const map_run<Element> run(q, surface, params, clock, asked);
    map_result found = solved(run);
    if (params.no_overlap) found = asked->kept_apart(run, std::move(found));
    map_result result = in_user_units(run, placed(run, std::move(found)));
    if (params.no_overlap) result = asked->certified_apart(run, std::move(result));
    clock.stages.add({.stage = "certify", .vertices = run.vertices()});
    result.report.stages = clock.stages.stages();
    return result;
}

/// All of parameterize().
template <class Element>
map_result parameterized(queue& q, const mesh<Element>& m, const parameterize_params& params,
                         const asked_phases<Element>* asked)
{
    const parameterize_params wanted = validated(params);
    const queue_counters before = q.counters();
    run_clock clock(wanted.time_limit, wanted.observer);
    map_result result = mapped<Element>(q, run_surface(m, wanted), wanted, clock, asked);
    result.report.counters = counted_since(before, q.counters());
    return result;
}

} // namespace detail

template <class Element>
map_result parameterize(queue& q, const mesh<Element>& m)
{
    return detail::parameterized<Element>(q, m, {}, nullptr);
}

template <class Element>
map_result parameterize(queue& q, const mesh<Element>& m, const parameterize_params& params)
{
    return detail::parameterized(q, m, params, &detail::all_phases<Element>);
}

} // namespace taut
