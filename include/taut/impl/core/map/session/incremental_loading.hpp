// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <taut/impl/core/constrain/long_rotation.hpp>
#include <taut/impl/core/constrain/prescribed_paths.hpp>
#include <taut/impl/core/map/session/initial_guess.hpp>
#include <taut/impl/core/map/session/repair.hpp>
#include <taut/impl/core/map/session/session_call.hpp>
#include <taut/impl/core/objective/running_map.hpp>
#include <taut/untangle.hpp>

namespace taut::impl
{

/// Returns whether it is proved that no map has the fixed coordinates at their targets, which the report then says. x:
/// any map.
template <class Element>
bool proved_infeasible(const running_map<Element>& map, const std::vector<vec<Element::dimension>>& x,
                       session_report& report)
{
    if constexpr (Element::oriented)
    {
        if (!map.fixed.marks().any()) return false;
        const auto proof = find_infeasibility(map.problem(x, false));
        if (!proof) return false;
        report.reason = proof.reason();
        report.ids = proof.proofs.front().ids;
        return true;
    }
    else
        return false;
}

/// Goes on in double where float leads no further; returns false where that may not be.
template <class Element>
bool in_double(running_map<Element>& map, session_report& report)
{
    if (!map.may_be_doubled()) return false;
    map.load(map.placed(), precision::fp64);
    report.notes.push_back("in float steps led no further; the last ones were in double");
    return true;
}

/// Brings the fixed coordinates of a running map nearer to their targets, in one call of a session: by Newton's steps
/// with prescribed displacements, in parts where bodies of fixed vertices rotate; in space from an initial guess with
/// all at their targets; where steps stick in double, and by untangling.
template <class Element>
class incremental_loading
{
public:
    static constexpr int D = Element::dimension;
    using coordinates = std::vector<vec<D>>;

    /// proof_sought: whether a proof was sought that there is no such map. Refers to its arguments.
    incremental_loading(running_map<Element>& map, session_call& call, bool& proof_sought)
        : map_(map), call_(call), proof_sought_(proof_sought)
    {
    }

    /// last: the map. rotations: those by which fixed vertices get to their targets; what is left of them afterwards.
    /// Returns whether all are at their targets.
    bool run(const coordinates& last, std::vector<long_rotation<D>>& rotations);

private:
    /// The same where targets tell the rotations.
    bool reach(const coordinates& last);

    /// Sets the targets to where fixed vertices are at the fraction t of their ways, of which these are the ends.
    void lead(double t, const coordinates& from, const fixed_coordinates<Element>& ends,
              const std::vector<long_rotation<D>>& rotations);

    prescribed_paths<D> paths(const coordinates& from) const
    {
        return {map_.of().rest.cells(), map_.fixed.marks(), from, map_.fixed.targets()};
    }

    /// Returns whether an initial guess is worth its cost: in space, with a budget of some twenty steps.
    bool may_guess() const { return D == 3 && Element::oriented && map_.fixed.slides().empty() && call_.lasts(20); }

    /// Tries an initial guess with fixed vertices at their targets. Returns whether it was taken.
    bool guess(const coordinates& last);

    /// Follows the path from a map in parts; returns whether its end was reached.
    bool follow(const coordinates& from);

    /// The same for one part. stuck_: steps do not help.
    bool follow_part(double distance);

    /// Untangles where steps bring fixed coordinates no nearer, if the budget would last for some twenty steps more, or
    /// a hundred for the whole mesh, for the time of a thousand steps at most. Its iterations count as steps. Returns
    /// whether it succeeded.
    bool untangled();

    running_map<Element>& map_;
    session_call& call_;
    bool& proof_sought_;
    stage_report did_;         ///< report of all steps so far
    bool guessed_ = false;     ///< an initial guess was tried on this path
    bool hard_ = false;        ///< the path needs an initial guess: the first step came less than a quarter of it
    bool stuck_ = false;       ///< steps bring fixed coordinates no nearer to their targets
    bool may_untangle_ = true; ///< not where a rotation is to be kept: untangling knows places alone
};

template <class Element>
bool incremental_loading<Element>::run(const coordinates& last, std::vector<long_rotation<D>>& rotations)
{
    int parts = 1;
    may_untangle_ = rotations.empty();
    for (auto& r : rotations)
    {
        r.find_done(last);
        parts = std::max(parts, r.parts());
    }
    const auto ends = map_.fixed;
    const auto whole = rotations;
    bool arrived = true;
    for (int part = 1; arrived && part < parts; ++part)
    {
        const double t = double(part) / parts;
        lead(t, last, ends, whole);
        const bool sought = std::exchange(proof_sought_, true); // a proof on the way would say nothing of its end
        arrived = reach(part == 1 ? last : map_.coordinates()) && call_.may_step();
        proof_sought_ = sought;
        if (!arrived) break;
        rotations = whole;
        for (auto& r : rotations) r.proceed(t);
    }
    if (parts > 1)
    {
        map_.fixed = ends;
        map_.aim();
    }
    if (!arrived || !reach(parts == 1 ? last : map_.coordinates())) return false;
    rotations.clear();
    return true;
}

template <class Element>
void incremental_loading<Element>::lead(double t, const coordinates& from, const fixed_coordinates<Element>& ends,
                                        const std::vector<long_rotation<D>>& rotations)
{
    auto marks = ends.marks();
    for (const auto& r : rotations)
        for (const idx v : r.vertices()) marks[static_cast<std::size_t>(v)] = 0;
    const prescribed_paths<D> paths(map_.of().rest.cells(), marks, from, ends.targets());
    auto there = ends.targets();
    for (std::size_t v = 0; v < there.size(); ++v)
        if (marks.any(v)) there[v] = paths.place(v, t);
    for (const auto& r : rotations) r.place(t, from, ends.targets(), there);
    map_.fixed.redirect(std::move(there));
    map_.aim();
}

template <class Element>
bool incremental_loading<Element>::reach(const coordinates& last)
{
    did_ = {};
    guessed_ = hard_ = stuck_ = false;
    if (may_guess() && paths(last).parts() > 1 && guess(last)) return true;
    bool arrived = follow(last);
    if (!arrived && hard_)
    {
        if (guess(last)) return true;
        if (call_.may_step()) arrived = follow(map_.coordinates());
    }
    // In the plane steps stick where pins are in each other's way, which no arithmetic changes.
    if (D == 3 && !arrived && stuck_ && call_.may_step() && in_double(map_, call_.report))
        arrived = follow(map_.coordinates());
    did_.stop = arrived ? "" : stuck_ ? "stuck" : call_.clock.refused() ? "user" : "limit";
    call_.book(&session_seconds::follow, std::move(did_));
    if constexpr (Element::oriented)
        if (!arrived && stuck_ && may_untangle_ && call_.may_step()) return untangled();
    return arrived;
}

template <class Element>
bool incremental_loading<Element>::guess(const coordinates& last)
{
    guessed_ = true;
    hard_ = false;
    if constexpr (D == 3 && Element::oriented)
    {
        const auto how = map_.on().device().has_fp64() ? precision::mixed : precision::fp32;
        auto found = guess_maker(map_.on(), call_.left(), how).make(map_.problem(last, true));
        call_.clock.stages.append(found.stages);
        call_.book(&session_seconds::follow, {.stage = "draft",
                                              .vertices = found.vertices,
                                              .iterations = found.steps,
                                              .stop = found.x.empty() ? "stuck" : "injective"});
        if (found.x.empty()) return false;
        map_.load_placed(std::move(found.x));
        return true;
    }
    else
        return false;
}

template <class Element>
bool incremental_loading<Element>::follow(const coordinates& from)
{
    const auto path = paths(from);
    const int parts = path.parts();
    bool goes_on = true;
    for (int part = 1; goes_on && part <= parts; ++part)
    {
        if (part > 1 && !call_.may_step())
        {
            goes_on = stuck_ = false;
            break;
        }
        const auto way = [&](std::size_t v) { return path.place(v, double(part) / parts); };
        if (parts > 1) map_.aim(way);
        goes_on = follow_part(map_.fixed.gap(part == 1 ? from : map_.coordinates(), way).distance);
    }
    if (parts > 1 && !goes_on) map_.aim(); // where the next call goes
    return goes_on;
}

template <class Element>
bool incremental_loading<Element>::follow_part(double distance)
{
    const double gap = std::max(distance * map_.of().unit, std::numeric_limits<double>::min());
    double mark = call_.clock.total();
    bool feasible = true;
    const auto proceed = [&](const solve::impl::prescribed_report& at)
    {
        call_.step_seconds = call_.clock.total() - std::exchange(mark, call_.clock.total());
        // Where it is hard to go on there may be no way.
        if (!proof_sought_ && at.left > 0.5 * gap)
        {
            proof_sought_ = true;
            feasible = !proved_infeasible(map_, map_.coordinates(), call_.report);
        }
        if (!guessed_ && at.left > 0.75 * gap) hard_ = may_guess();
        progress p = map_.seen();
        p.iteration = at.iterations;
        p.value = at.value;
        return feasible && !hard_ && at.iterations < call_.steps_left &&
               call_.clock.left().count() > call_.step_seconds && call_.clock.proceed(p);
    };
    const auto found = map_.follow(gap, proceed);
    call_.count(found.iterations);
    call_.report.energy = found.value;
    did_.stage = "follow";
    if (did_.iterations == 0) did_.energy_before = found.value_start;
    did_.iterations += found.iterations;
    did_.energy_after = found.value;
    stuck_ = found.crawling && feasible;
    return found.arrived;
}

template <class Element>
bool incremental_loading<Element>::untangled()
{
    bool done = false;
    int before = 0, now = 0; // iterations of untanglings that have ended, and of the one at work
    if (call_.lasts(20))
    {
        const run_limits limits{
            .time_limit = std::min(call_.clock.left(), std::chrono::duration<double>(1000 * call_.step_seconds)),
            .observer = [&](const progress& p)
            {
                if (p.iteration < now) before += now;
                now = p.iteration;
                return before + now < call_.steps_left && call_.clock.ask({.iterate = false});
            }};
        auto found = repaired(map_.on(), map_.problem(map_.coordinates(), true), limits, call_.lasts(100));
        call_.count(before + now);
        done = bool(found);
        if (done)
        {
            map_.load_placed(*std::move(found));
            call_.report.notes.push_back("steps stuck; the map was untangled with the pins at their places");
        }
    }
    call_.book(&session_seconds::repair,
               {.stage = "repair", .iterations = before + now, .stop = done ? "injective" : "stuck"});
    return done;
}

// Compiled once, with the bodies.
extern template class incremental_loading<triangle>;

} // namespace taut::impl
