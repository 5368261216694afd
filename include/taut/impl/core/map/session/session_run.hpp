// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <span>
#include <string>
#include <utility>

#include <taut/impl/core/compute/queue_counters.hpp>
#include <taut/impl/core/map/session/incremental_loading.hpp>
#include <taut/impl/core/map/session/session_body.hpp>
#include <taut/impl/core/map/session/session_setup.hpp>
#include <taut/impl/core/measure/describe_defects.hpp>
#include <taut/impl/core/measure/distortion.hpp>
#include <taut/impl/core/solve/stop.hpp>
#include <taut/quality.hpp>

namespace taut::impl
{

/// Interactive session on a device: keeps a running map, and advances it to the current constraints.
template <class Element>
class session_run final : public session_body<Element>
{
    using base = session_body<Element>;

public:
    static constexpr int D = Element::dimension;
    using typename base::map;

    /// Throws parameter_error, constraint_error.
    session_run(const queue& q, session_setup<Element> setup);

    session_result<Element> solve(const session_budget& budget) override;

    void restore(const constraints<Element>& asked, const map& x) override;

private:
    using base::last, base::changed, base::wanted;

    /// Computes the first map of a surface and moves it to the device; called again after a failure.
    void begin(session_call& call);

    /// The same from a given shape, untangled if need be.
    void begin_shape(session_call& call);

    /// Untangles the given shape with the defects `flips`, unless its elements have no orientation.
    bool untangled(session_call& call, certificate& flips);

    /// Energy of a shape without inverted elements, computed on the host.
    double energy_of(const map& x) const;

    /// Continues from the last map.
    void advance(session_call& call);

    /// Minimises with fixed coordinates where they are.
    void minimise(session_call& call, bool arrived);

    solve::report minimised(session_call& call);

    /// Returns whether it ended by rounding, above the tolerance.
    bool stalled(const solve::report& r) const;

    /// Accepts the map on the device if it is certified; else restores the last one.
    void take(session_call& call);

    /// Notes how far fixed coordinates of the last map are from their targets, and rotations from their ends.
    void note_gap();

    static constexpr int most_in_float = 300; ///< steps, where double can go on; what converges in float takes fewer

    session_setup<Element> setup_;
    running_map<Element> map_;
    bool proof_sought_ = false; ///< that what is asked now cannot be
    double step_seconds_ = 0;   ///< of the last step
};

template <class Element>
session_run<Element>::session_run(const queue& q, session_setup<Element> setup)
    : setup_(std::move(setup)), map_(q, setup_.of)
{
    const auto method = setup_.solve.method;
    if (method != solve::method::automatic && method != solve::method::newton)
        throw parameter_error("solve.method", "must be automatic or newton: a session makes Newton's steps");
    map_.automatic = !setup_.first && setup_.precision == precision::automatic;
    wanted = setup_.constraints.on(setup_.of.rest);
}

template <class Element>
session_result<Element> session_run<Element>::solve(const session_budget& budget)
{
    const queue_counters before = map_.on().counters();
    session_report& r = last.report;
    session_call call{r,
                      run_clock(map_.loaded() ? budget.time : std::min(budget.time, setup_.limits.time_limit),
                                setup_.limits.observer),
                      budget.steps, step_seconds_, setup_.of.rest.points().size()};
    r.seconds = {};
    if (map_.loaded())
        advance(call);
    else if (setup_.first)
        begin(call);
    else
        begin_shape(call);
    step_seconds_ = call.step_seconds;
    r.stopped =
        !r.converged && (call.steps_left <= 0 || call.clock.over() || call.clock.left().count() <= step_seconds_);
    r.stages = call.clock.stages.stages();
    r.counters = counted_since(before, map_.on().counters());
    return last;
}

template <class Element>
void session_run<Element>::restore(const constraints<Element>& asked, const map& x)
{
    if (!map_.loaded()) throw parameter_error("x", "cannot be restored: there is no map yet; call solve() first");
    if (x.size() != last.x.size())
        throw parameter_error("x", std::to_string(x.size()) + " positions for " + std::to_string(last.x.size()) +
                                       " vertices");
    auto there = asked.on(setup_.of.rest);
    auto flips = map_.certified(x);
    if (!flips) throw parameter_error("x", "is not injective: restore a map that solve() returned");
    wanted = std::move(there);
    last.x = x;
    last.report.flips = std::move(flips);
    last.report.converged = false;
    changed = true; // so that the next solve() sees which coordinates are fixed
    map_.load(x);
}

template <class Element>
void session_run<Element>::begin(session_call& call)
{
    auto found = setup_.first(wanted, call.clock);
    last = std::move(found.result);
    session_report& r = last.report;
    if (last)
    {
        setup_.of.unit = found.unit;
        map_.fixed = {last.x, setup_.still};
        map_.load(last.x, found.precision);
        map_.constrain(wanted);
        wanted.rotations({}); // it is at their ends
        r.pins_held = true;
        changed = false;
    }
    r.seconds.start = call.clock.total();
    call.clock.stages.add({.stage = "prepare", .vertices = call.vertices});
}

template <class Element>
void session_run<Element>::begin_shape(session_call& call)
{
    session_report& r = last.report = {};
    map_.fixed = {setup_.start, {}, setup_.slides};
    map_.fixed.take(wanted);
    auto flips = map_.certified(setup_.start);
    last.x.clear();
    if (!flips && !untangled(call, flips)) return;
    last.x = setup_.start;
    r.outcome = outcome::valid;
    r.flips = std::move(flips);
    note_gap();
    call.clock.has_result(true);
    if (proved_infeasible(map_, last.x, r)) return;
    if (!call.clock.proceed())
    {
        r.energy = energy_of(last.x);
        return;
    }
    const precision how = setup_.precision != precision::automatic ? setup_.precision
                          : map_.on().device().has_fp64()          ? precision::mixed
                                                                   : precision::fp32;
    map_.load(last.x, how);
    changed = true;
    call.book(&session_seconds::start, {.stage = "start"});
    const auto notes = std::exchange(r.notes, {});
    advance(call);
    r.notes.insert(r.notes.begin(), notes.begin(), notes.end());
}

template <class Element>
bool session_run<Element>::untangled(session_call& call, certificate& flips)
{
    session_report& r = last.report;
    if constexpr (Element::oriented)
    {
        auto found = untangle(map_.on(), map_.problem(setup_.start, false), {}, call.left());
        call.clock.stages.append(found.stages);
        r.outcome = found.outcome == outcome::infeasible ? outcome::infeasible : outcome::gave_up;
        r.reason = std::move(found.reason);
        r.ids = std::move(found.ids);
        if (!found) return false;
        r.reason.clear();
        r.notes.push_back("the shape had " + describe_defects<Element>(flips, setup_.of.owners) + "; it was untangled");
        setup_.start = setup_.of.unscaled(std::move(found.map));
        flips = std::move(found.flips);
        return true;
    }
    else
    {
        r.outcome = outcome::gave_up;
        r.reason = "the shape to begin with has " + describe_defects<Element>(flips);
        r.ids = flips.ids;
        return false;
    }
}

template <class Element>
double session_run<Element>::energy_of(const map& x) const
{
    const auto& of = setup_.of;
    const map scaled = of.scaled(x);
    const means e = mean_over(of.rest, of.ideal, std::span<const vec<D>>(scaled),
                              [&of](const element<double, D>& here) { return of.energy(here); });
    return of.weights == energy::weighting::measure ? e.measure : e.uniform;
}

template <class Element>
void session_run<Element>::advance(session_call& call)
{
    session_report& r = last.report;
    r.steps = 0;
    r.notes.clear();
    if (!changed && r.converged) return;
    if (changed)
    {
        map_.constrain(wanted);
        proof_sought_ = false;
        r.reason.clear();
        r.ids.clear();
    }
    changed = r.converged = false;
    call.clock.has_result(true);
    call.book(&session_seconds::constrain, {.stage = "constrain"});
    bool arrived = map_.fixed.gap(last.x).vertex < 0 && wanted.rotations().empty();
    if (!arrived && r.reason.empty())
    {
        auto rotations = wanted.rotations();
        arrived = incremental_loading(map_, call, proof_sought_).run(last.x, rotations);
        wanted.rotations(std::move(rotations));
    }
    if (r.steps == 0 || (arrived && call.may_step())) minimise(call, arrived);
    take(call);
}

template <class Element>
void session_run<Element>::minimise(session_call& call, bool arrived)
{
    auto found = minimised(call);
    const bool cut = found.stop == solve::stop::iterations && setup_.solve.max_iterations > most_in_float;
    if ((cut || stalled(found)) && call.may_step() && in_double(map_, call.report)) found = minimised(call);
    session_report& r = last.report;
    r.energy = found.value;
    r.gradient = found.gradient_norm;
    r.converged = arrived && solve::impl::converged(found.stop);
    auto did = stage_of("minimise", 0, 0, found);
    did.cut_by = corners_of(setup_.of.rest.cells(), found.capping);
    call.book(&session_seconds::solve, std::move(did));
}

template <class Element>
solve::report session_run<Element>::minimised(session_call& call)
{
    auto how = setup_.solve;
    auto& most = how.max_iterations;
    most = std::min(most, call.steps_left);
    // Float next to a barrier may go on for as long as it is let, with nothing gained.
    if (map_.may_be_doubled()) most = std::min(most, most_in_float);
    const auto ask = [&](progress p)
    {
        const progress now = map_.seen();
        p.coordinates = now.coordinates;
        p.positions = now.positions;
        return call.clock.ask(p);
    };
    const std::chrono::duration<double> left(std::max(call.clock.left().count() - call.step_seconds, 0.0));
    auto found = map_.minimise(how, {left, ask});
    call.count(found.iterations);
    return found;
}

template <class Element>
bool session_run<Element>::stalled(const solve::report& r) const
{
    constexpr double of_rounding = 1e-8;                      // a tolerance that is larger is meant
    if (r.stop == solve::stop::not_finite_start) return true; // in float, of a shape that is certified
    const auto& asked = setup_.solve;
    return r.gradient_norm > asked.gradient_tolerance &&
           (r.stop == solve::stop::line_search || r.stop == solve::stop::barrier ||
            (r.stop == solve::stop::decrease && asked.decrease_tolerance < of_rounding));
}

template <class Element>
void session_run<Element>::take(session_call& call)
{
    session_report& r = last.report;
    auto x = map_.placed();
    auto flips = map_.certified(x);
    if (flips)
    {
        r.flips = std::move(flips);
        last.x = std::move(x);
    }
    else
    {
        r.notes.push_back("in exact arithmetic the map had " + describe_defects<Element>(flips, setup_.of.owners) +
                          "; the last one is returned");
        r.converged = false;
        map_.load(last.x);
    }
    note_gap();
    call.book(&session_seconds::certificate, {.stage = "certify"});
}

template <class Element>
void session_run<Element>::note_gap()
{
    const auto gap = map_.fixed.gap(last.x);
    auto rotations = wanted.rotations();
    for (auto& r : rotations) r.find_done(last.x);
    last.report.pins_held = gap.vertex < 0 && rotations.empty();
    last.report.farthest = gap.vertex < 0 && !rotations.empty() ? rotations[0].vertices()[0] : gap.vertex;
    last.report.distance = gap.distance;
    wanted.rotations(std::move(rotations));
}

// Compiled once, with the bodies.
extern template class session_run<triangle>;

} // namespace taut::impl
