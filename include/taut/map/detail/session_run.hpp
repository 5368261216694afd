// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <taut/map/detail/held_places.hpp>
#include <taut/map/detail/live_map.hpp>
#include <taut/map/detail/parameterization.hpp>
#include <taut/map/detail/session_body.hpp>
#include <taut/map/detail/session_repair.hpp>

namespace taut::detail
{

/// What session.hpp declares; include that one.
///
/// A session at work: the map on the device that goes from the last map to what is asked. A template, as parameterize()
/// is, so that only files that make a session compile it.
template <class Element>
class session_run final : public session_body
{
    static_assert(std::is_same_v<Element, triangle>, "surfaces only");

public:
    using map = std::vector<vec2>;

    session_run(const queue& q, const mesh<Element>& m, const parameterize_params& params)
        : queue_(q), params_(validated(params)), in_(m, params_)
    {
        if (params_.solve.method != solve::method::automatic && params_.solve.method != solve::method::newton)
            throw parameter_error("solve.method", "must be automatic or newton: a session makes Newton's steps");
        wanted = params_.constraints.on(in_.surface);
    }

    session_result solve(const session_budget& budget) override
    {
        const queue_counters before = queue_.counters();
        run_clock clock(last ? budget.time : std::min(budget.time, params_.time_limit), params_.observer);
        seconds_ = {};
        steps_left_ = budget.steps;
        if (last)
            advance(clock);
        else
            begin(clock);
        last.report.seconds = seconds_;
        last.report.counters = counted_since(before, queue_.counters());
        return last;
    }

private:
    /// The first map: that of parameterize(), and the tables for all further ones.
    void begin(run_clock& clock)
    {
        params_.constraints = wanted;
        map_result first = mapped<Element>(queue_, in_, params_, clock);
        session_report& r = last.report = {};
        r.outcome = first.report.outcome;
        r.reason = std::move(first.report.reason);
        r.ids = std::move(first.report.ids);
        r.notes = std::move(first.report.notes);
        r.flips = std::move(first.report.flips);
        r.energy = first.report.solve.value;
        r.gradient = first.report.solve.gradient_norm;
        r.steps = first.report.solve.iterations;
        if (first)
        {
            lengths_ = in_.unit / first.report.scale;
            held_ = held_places(first.uv, in_.fixed_boundary(params_.boundary));
            live_.emplace(queue_, in_.surface, params_, first.report.precision, scaled(first.uv));
            last.uv = std::move(first.uv);
            constrain();
            r.pins_held = true;
            r.converged = is_converged(first.report.solve.stop);
            changed = false;
        }
        seconds_.start = clock.total();
    }

    /// From the last map on.
    void advance(run_clock& clock)
    {
        session_report& r = last.report;
        r.steps = 0;
        r.notes.clear();
        if (!changed && r.converged) return;
        if (changed)
        {
            constrain();
            r.reason.clear();
            r.ids.clear();
        }
        changed = r.converged = false;
        clock.has_result(true);
        book(clock, &session_seconds::constrain);
        if (on_way_ && r.reason.empty()) follow(clock);
        if (r.steps == 0 || (!on_way_ && may_step(clock))) minimise(clock);
        take(clock);
    }

    /// Tells the map on the device who is held, if that has changed, and where.
    void constrain()
    {
        auto springs = point_constraints<2>{{}, wanted.springs()}.scaled(lengths_).springs;
        const bool other_marks = held_.take(wanted);
        if (other_marks || !springs.empty() || !springs_.empty())
        {
            springs_ = std::move(springs);
            live_->constrain(held_.marks(), springs_);
        }
        live_->aim(scaled(held_.places()));
        on_way_ = held_.gap(last.uv).vertex >= 0;
    }

    /// Takes another map in the place of the one on the device.
    void load(const map& run_lengths)
    {
        live_->load(run_lengths);
        live_->constrain(held_.marks(), springs_);
        live_->aim(scaled(held_.places()));
    }

    bool may_step(run_clock& clock)
    {
        return steps_left_ > 0 && clock.left().count() > step_seconds_ && clock.proceed();
    }

    /// Brings held coordinates nearer to their places.
    void follow(run_clock& clock)
    {
        const double gap = held_.gap(last.uv).distance * lengths_;
        double mark = clock.total();
        bool feasible = true, asked = false;
        const auto proceed = [&](const solve::prescribed_report& at)
        {
            step_seconds_ = clock.total() - std::exchange(mark, clock.total());
            // Where it is hard to go on there may be no way.
            if (!std::exchange(asked, asked || at.left > 0.5 * gap) && at.left > 0.5 * gap) feasible = !proved();
            progress p = seen();
            p.iteration = at.iterations;
            p.value = at.value;
            return feasible && at.iterations < steps_left_ && clock.left().count() > step_seconds_ && clock.proceed(p);
        };
        const auto found = live_->follow(gap, proceed);
        steps_left_ -= found.iterations;
        last.report.steps += found.iterations;
        last.report.energy = found.value;
        on_way_ = !found.arrived;
        book(clock, &session_seconds::follow);
        if (!found.crawling || !feasible || !may_step(clock)) return;
        repair(clock);
        book(clock, &session_seconds::repair);
    }

    /// The map with held coordinates at their places, whatever flips.
    untangle_problem<Element> problem() const
    {
        auto x = user_coordinates();
        untangle_problem<Element> p{in_.surface, x, held_.marks(), scaled(x)};
        held_.impose(p.initial);
        p.initial = scaled(p.initial);
        return p;
    }

    /// Whether it is proved that no map has the held coordinates at their places.
    bool proved()
    {
        const auto proof = find_infeasibility(problem());
        if (!proof) return false;
        last.report.reason = proof.reason();
        last.report.ids = proof.proofs.front().ids;
        return true;
    }

    /// Untangling, where steps do not bring held coordinates any nearer, if the budget would last for some twenty steps
    /// more, or a hundred for the whole mesh; no longer than a thousand take. Its iterations count as steps.
    void repair(run_clock& clock)
    {
        const auto lasts = [&](int steps)
        { return steps_left_ >= steps && clock.left().count() >= steps * step_seconds_; };
        if (!lasts(20)) return;
        int before = 0, now = 0; // iterations of untanglings that have ended, and of the one at work
        const repair_limits limits{.whole = lasts(100),
                                   .time = std::min(clock.left(), std::chrono::duration<double>(1000 * step_seconds_)),
                                   .ask = [&](const progress& p)
                                   {
                                       if (p.iteration < now) before += now;
                                       now = p.iteration;
                                       return before + now < steps_left_ && clock.ask({.iterate = false});
                                   }};
        const auto found = repaired(queue_, problem(), params_.untangling, limits);
        steps_left_ -= std::min(before + now, steps_left_);
        last.report.steps += before + now;
        if (!found) return;
        load(*found);
        on_way_ = false;
        last.report.notes.push_back("steps stuck; the map was untangled with the pins at their places");
    }

    /// With what is held where it is.
    void minimise(run_clock& clock)
    {
        auto how = params_.solve;
        how.stopping.max_iterations = std::min(how.stopping.max_iterations, steps_left_);
        how.stopping.time_limit = std::chrono::duration<double>(std::max(clock.left().count() - step_seconds_, 1e-9));
        const auto found = live_->minimize(how,
                                           [&](progress p)
                                           {
                                               p.coordinates = seen().coordinates;
                                               return clock.ask(p);
                                           });
        session_report& r = last.report;
        r.steps += found.iterations;
        r.energy = found.value;
        r.gradient = found.gradient_norm;
        r.converged = !on_way_ && is_converged(found.stop);
        book(clock, &session_seconds::solve);
    }

    /// Makes the map on the device the last one, if it is certified; else goes back to the last one.
    void take(run_clock& clock)
    {
        session_report& r = last.report;
        auto x = user_coordinates();
        held_.impose(x, unscaled(live_->as_held(scaled(held_.places()))));
        auto flips = certify<2>(in_.surface.cells(), std::span<const vec2>(x), in_.ideal.measure);
        if (flips)
        {
            for (double* det : {&flips.min_det, &flips.max_det}) *det *= lengths_ * lengths_;
            r.flips = std::move(flips);
            last.uv = std::move(x);
        }
        else
        {
            r.notes.push_back("in exact arithmetic the map had " + describe_defects<Element>(flips) +
                              "; the last one is returned");
            r.converged = false;
            load(scaled(last.uv));
        }
        const auto gap = held_.gap(last.uv);
        on_way_ = gap.vertex >= 0;
        r.pins_held = !on_way_;
        r.farthest = gap.vertex;
        r.distance = gap.distance;
        book(clock, &session_seconds::certificate);
    }

    static bool is_converged(solve::stop s) { return s == solve::stop::gradient || s == solve::stop::decrease; }

    /// What an observer sees of the map.
    progress seen() const
    {
        return {.coordinates = [this] { return user_coordinates(); }};
    }

    map user_coordinates() const { return unscaled(live_->coordinates()); }

    /// In the lengths of the map.
    map unscaled(map x) const
    {
        for (vec2& p : x) p /= lengths_;
        return x;
    }

    /// In the lengths of the run.
    map scaled(map x) const
    {
        for (vec2& p : x) p *= lengths_;
        return x;
    }

    void book(run_clock& clock, double session_seconds::*phase) { seconds_.*phase += clock.lap(); }

    queue queue_;
    parameterize_params params_; ///< validated
    run_surface in_;
    double lengths_ = 1; ///< of the run by those of the map
    std::optional<live_map<Element>> live_;
    held_places held_;
    std::vector<spring<2>> springs_; ///< in the lengths of the run
    bool on_way_ = false;            ///< held coordinates of the map on the device are not at their places
    double step_seconds_ = 0;        ///< of the last step
    int steps_left_ = 0;
    session_seconds seconds_;
};

} // namespace taut::detail

template <class Element>
taut::session::session(queue& q, const mesh<Element>& m, const parameterize_params& params)
    : body_(std::make_unique<detail::session_run<Element>>(q, m, params))
{
}
