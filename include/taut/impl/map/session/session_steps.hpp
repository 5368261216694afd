// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/constrain/prescribed_paths.hpp>
#include <taut/impl/map/run_clock.hpp>
#include <taut/impl/map/session/held_map.hpp>
#include <taut/impl/map/session/repair.hpp>
#include <taut/impl/map/session/turned_draft.hpp>
#include <taut/impl/measure/describe_defects.hpp>
#include <taut/impl/untangle/proofs/infeasible.hpp>
#include <taut/impl/untangle/untangle_declared.hpp>

namespace taut::impl
{

/// Session with a device: advances the map on the device to the current constraints. Derived classes make the first
/// map. A template, as parameterize() is, so that only files that make a session compile it.
template <class Element>
class session_steps : public held_map<Element>
{
    using base = held_map<Element>;

public:
    static constexpr int D = Element::dimension;
    using typename base::map;

    session_result<Element> solve(const session_budget& budget) override
    {
        const queue_counters before = queue_.counters();
        run_clock clock(live_ ? budget.time : std::min(budget.time, limit_), observer_);
        seconds_ = {};
        steps_left_ = budget.steps;
        if (live_)
            advance(clock);
        else
            begin(clock);
        last.report.stopped =
            !last.report.converged && (steps_left_ <= 0 || clock.over() || clock.left().count() <= step_seconds_);
        last.report.seconds = seconds_;
        last.report.stages = clock.stages.stages();
        last.report.counters = counted_since(before, queue_.counters());
        return last;
    }

    void restore(const constraints<Element>& asked, const map& x) override
    {
        if (!live_) throw parameter_error("x", "cannot be restored: there is no map yet; call solve() first");
        if (x.size() != last.x.size())
            throw parameter_error("x", std::to_string(x.size()) + " positions for " + std::to_string(last.x.size()) +
                                           " vertices");
        auto there = asked.on(rest());
        auto flips = certified(x);
        if (!flips) throw parameter_error("x", "is not injective: restore a map that solve() returned");
        this->wanted = std::move(there);
        last.x = x;
        last.report.flips = std::move(flips);
        last.report.converged = false;
        changed = true; // so that the next solve() sees which coordinates are fixed
        load(scaled(x));
    }

protected:
    using base::last, base::changed, base::queue_, base::lengths_, base::live_, base::held_, base::on_way_;
    using base::rest, base::constrain, base::load, base::problem, base::certified, base::seen, base::marks,
        base::scaled;
    using base::user_coordinates, base::placed, base::owners;

    /// Params: of maps or shapes, validated. time_limit is for the first map.
    template <class Params>
    session_steps(queue q, const Params& params)
        : base(std::move(q)),
          solve_(params.solve),
          untangling_(params.untangling),
          observer_(params.limits.observer),
          limit_(params.limits.time_limit)
    {
        if (solve_.method != solve::method::automatic && solve_.method != solve::method::newton)
            throw parameter_error("solve.method", "must be automatic or newton: a session makes Newton's steps");
    }

    /// Moves the current map to the device in double; returns false where it is so already, or may not be.
    virtual bool in_double() { return false; }

    /// Returns whether in_double() would do so.
    virtual bool may_be_doubled() const { return false; }

    /// Makes the first map and moves it to the device; called again after a failure.
    virtual void begin(run_clock& clock) = 0;

    /// Continues from the last map.
    void advance(run_clock& clock)
    {
        session_report& r = last.report;
        r.steps = 0;
        r.notes.clear();
        if (!changed && r.converged) return;
        if (changed)
        {
            constrain();
            proof_sought_ = false;
            r.reason.clear();
            r.ids.clear();
        }
        changed = r.converged = false;
        clock.has_result(true);
        book(clock, &session_seconds::constrain, {.stage = "constrain"});
        if (on_way_ && r.reason.empty()) follow(clock);
        if (r.steps == 0 || (!on_way_ && may_step(clock))) minimise(clock);
        take(clock);
    }

    bool may_step(run_clock& clock)
    {
        return steps_left_ > 0 && clock.left().count() > step_seconds_ && clock.proceed();
    }

    /// Brings fixed coordinates nearer to their targets.
    void follow(run_clock& clock)
    {
        drafted_ = false;
        if (may_draft(clock) && turns() && draft(clock)) return;
        bool arrived = follow_parts(clock, last.x);
        if (!arrived && hard_)
        {
            if (draft(clock)) return;
            if (may_step(clock)) arrived = follow_parts(clock, user_coordinates());
        }
        // In the plane steps stick where pins are in each other's way, which no arithmetic changes.
        if (D == 3 && !arrived && stuck_ && may_step(clock) && in_double())
            arrived = follow_parts(clock, user_coordinates());
        on_way_ = !arrived;
        followed_.stop = arrived ? "" : stuck_ ? "stuck" : clock.refused() ? "user" : "limit";
        book(clock, &session_seconds::follow, std::exchange(followed_, {}));
        if constexpr (Element::oriented)
        {
            if (arrived || !stuck_ || !may_step(clock)) return;
            const int before = last.report.steps;
            const bool repaired = repair(clock);
            book(clock, &session_seconds::repair,
                 {.stage = "repair",
                  .iterations = last.report.steps - before,
                  .stop = repaired ? "injective" : "stuck"});
        }
    }

    /// Returns whether an initial guess is worth its cost: in space, with a budget of some twenty steps.
    bool may_draft(const run_clock& clock) const
    {
        return D == 3 && Element::oriented && held_.slides().empty() && lasts(clock, 20);
    }

    /// Returns whether bodies of fixed vertices rotate on the path.
    bool turns() const
    {
        return prescribed_paths<D>(rest().cells(), marks(), scaled(last.x), scaled(held_.places())).parts() > 1;
    }

    /// Tries an initial guess with fixed vertices at their targets. Returns whether it was taken.
    bool draft(run_clock& clock)
    {
        drafted_ = true;
        hard_ = false;
        if constexpr (D == 3 && Element::oriented)
        {
            auto how = untangling_;
            how.limits.time_limit = clock.left();
            how.limits.observer = [&clock](const progress&) { return clock.ask({.iterate = false}); };
            const draft_maker maker(queue_, how, queue_.device().has_fp64() ? precision::mixed : precision::fp32);
            auto found = maker.draft(problem(last.x, true));
            clock.stages.append(found.stages);
            book(clock, &session_seconds::follow,
                 {.stage = "draft",
                  .vertices = found.vertices,
                  .iterations = found.steps,
                  .stop = found.x.empty() ? "stuck" : "injective"});
            if (found.x.empty()) return false;
            load(found.x);
            on_way_ = false;
            return true;
        }
        else
            return false;
    }

    /// Brings fixed vertices of a map to their targets, in parts where bodies of them rotate; returns whether they have
    /// arrived.
    bool follow_parts(run_clock& clock, const map& from)
    {
        const prescribed_paths<D> paths(rest().cells(), marks(), from, held_.places());
        const int parts = paths.parts();
        bool goes_on = true;
        int gone = 0;
        while (goes_on && gone < parts)
        {
            if (gone > 0 && !may_step(clock))
            {
                goes_on = stuck_ = false;
                break;
            }
            map way = held_.places();
            paths.place(static_cast<double>(gone + 1) / parts, way);
            if (parts > 1) live_->aim(scaled(way));
            goes_on = follow(clock, gone == 0 ? from : user_coordinates(), way);
            if (goes_on) ++gone;
        }
        if (parts > 1 && !goes_on) live_->aim(scaled(held_.places())); // where the next call goes
        return goes_on;
    }

    /// Follows one part of the path from a map; returns whether its end was reached. stuck_: steps do not help.
    bool follow(run_clock& clock, const map& from, const map& way)
    {
        const double gap = std::max(held_.gap(from, way).distance * lengths_, std::numeric_limits<double>::min());
        double mark = clock.total();
        bool feasible = true;
        const auto proceed = [&](const solve::impl::prescribed_report& at)
        {
            step_seconds_ = clock.total() - std::exchange(mark, clock.total());
            // Where it is hard to go on there may be no way.
            if (!proof_sought_ && at.left > 0.5 * gap)
            {
                proof_sought_ = true;
                feasible = !proved(user_coordinates());
            }
            if (!drafted_ && at.left > 0.75 * gap) hard_ = may_draft(clock);
            progress p = seen();
            p.iteration = at.iterations;
            p.value = at.value;
            return feasible && !hard_ && at.iterations < steps_left_ && clock.left().count() > step_seconds_ &&
                   clock.proceed(p);
        };
        const auto found = live_->follow(gap, proceed);
        steps_left_ -= found.iterations;
        last.report.steps += found.iterations;
        last.report.energy = found.value;
        followed_.stage = "follow";
        if (followed_.iterations == 0) followed_.energy_before = found.value_start;
        followed_.iterations += found.iterations;
        followed_.energy_after = found.value;
        stuck_ = found.crawling && feasible;
        return found.arrived;
    }

    /// Returns whether it is proved that no map has the fixed coordinates at their targets; x: any map.
    bool proved(const map& x)
    {
        if constexpr (Element::oriented)
        {
            if (!marks().any()) return false;
            const auto proof = find_infeasibility(problem(x, false));
            if (!proof) return false;
            last.report.reason = proof.reason();
            last.report.ids = proof.proofs.front().ids;
            return true;
        }
        else
            return false;
    }

    /// Untangles to a map with fixed coordinates at their targets and no defect, if there is one.
    untangle_result<Element> untangled(run_clock& clock, const map& x)
    {
        auto how = untangling_;
        how.limits.time_limit = clock.left();
        how.limits.observer = [&clock](const progress&) { return clock.ask({.iterate = false}); };
        auto found = untangle(queue_, problem(x, false), how);
        clock.stages.append(found.stages);
        return found;
    }

    /// Returns whether the budget would last for so many steps.
    bool lasts(const run_clock& clock, int steps) const
    {
        return steps_left_ >= steps && clock.left().count() >= steps * step_seconds_;
    }

    /// Untangles where steps bring fixed coordinates no nearer, if the budget would last for some twenty steps more, or
    /// a hundred for the whole mesh, for the time of a thousand steps at most. Its iterations count as steps. Returns
    /// whether it succeeded.
    bool repair(run_clock& clock)
    {
        if (!lasts(clock, 20)) return false;
        int before = 0, now = 0; // iterations of untanglings that have ended, and of the one at work
        const repair_limits limits{.whole = lasts(clock, 100),
                                   .time = std::min(clock.left(), std::chrono::duration<double>(1000 * step_seconds_)),
                                   .ask = [&](const progress& p)
                                   {
                                       if (p.iteration < now) before += now;
                                       now = p.iteration;
                                       return before + now < steps_left_ && clock.ask({.iterate = false});
                                   }};
        const auto found = repaired(queue_, problem(user_coordinates(), true), untangling_, limits);
        steps_left_ -= std::min(before + now, steps_left_);
        last.report.steps += before + now;
        if (!found) return false;
        load(*found);
        on_way_ = false;
        last.report.notes.push_back("steps stuck; the map was untangled with the pins at their places");
        return true;
    }

    /// Minimises with fixed coordinates where they are.
    void minimise(run_clock& clock)
    {
        auto found = minimised(clock);
        const bool cut = found.stop == solve::stop::iterations && solve_.stopping.max_iterations > most_in_float;
        if ((cut || stalled(found)) && may_step(clock) && in_double()) found = minimised(clock);
        session_report& r = last.report;
        r.energy = found.value;
        r.gradient = found.gradient_norm;
        r.converged = !on_way_ && solve::impl::converged(found.stop);
        auto did = stage_of("minimise", 0, 0, found);
        did.cut_by = corners_of(rest().cells(), found.capping);
        book(clock, &session_seconds::solve, std::move(did));
    }

    solve::report minimised(run_clock& clock)
    {
        auto how = solve_;
        how.stopping.max_iterations = std::min(how.stopping.max_iterations, steps_left_);
        // Float next to a barrier may go on for as long as it is let, with nothing gained.
        if (may_be_doubled()) how.stopping.max_iterations = std::min(how.stopping.max_iterations, most_in_float);
        how.stopping.time_limit = std::chrono::duration<double>(std::max(clock.left().count() - step_seconds_, 1e-9));
        auto found = live_->minimize(how,
                                     [&](progress p)
                                     {
                                         const progress now = seen();
                                         p.coordinates = now.coordinates;
                                         p.positions = now.positions;
                                         return clock.ask(p);
                                     });
        last.report.steps += found.iterations;
        steps_left_ -= found.iterations;
        return found;
    }

    /// Returns whether it ended by rounding, above the tolerance.
    bool stalled(const solve::report& r) const
    {
        constexpr double of_rounding = 1e-8;                      // a tolerance that is larger is meant
        if (r.stop == solve::stop::not_finite_start) return true; // in float, of a shape that is certified
        return r.gradient_norm > solve_.stopping.gradient_tolerance &&
               (r.stop == solve::stop::line_search || r.stop == solve::stop::barrier ||
                (r.stop == solve::stop::decrease && solve_.stopping.decrease_tolerance < of_rounding));
    }

    /// Accepts the map on the device if it is certified; else restores the last one.
    void take(run_clock& clock)
    {
        session_report& r = last.report;
        auto x = placed();
        auto flips = certified(x);
        if (flips)
        {
            r.flips = std::move(flips);
            last.x = std::move(x);
        }
        else
        {
            r.notes.push_back("in exact arithmetic the map had " + describe_defects<Element>(flips, owners()) +
                              "; the last one is returned");
            r.converged = false;
            load(scaled(last.x));
        }
        note_gap();
        on_way_ = !r.pins_held;
        book(clock, &session_seconds::certificate, {.stage = "certify"});
    }

    /// Notes the distance of fixed coordinates of the last map from their targets.
    void note_gap()
    {
        const auto gap = held_.gap(last.x);
        last.report.pins_held = gap.vertex < 0;
        last.report.farthest = gap.vertex;
        last.report.distance = gap.distance;
    }

    /// Attributes the time since the end of the last stage to this one.
    void book(run_clock& clock, double session_seconds::*phase, stage_report did)
    {
        seconds_.*phase += clock.lap();
        if (did.vertices == 0) did.vertices = rest().points().size();
        clock.stages.add(std::move(did));
    }

    session_seconds seconds_;

private:
    static constexpr int most_in_float = 300; ///< steps, where double can go on; what converges in float takes fewer

    solve::params solve_;
    untangle_params untangling_;
    taut::observer observer_;
    std::chrono::duration<double> limit_;
    stage_report followed_;     ///< report of the incremental loading so far
    bool proof_sought_ = false; ///< that what is asked now cannot be
    bool drafted_ = false;      ///< an initial guess was tried on this path
    bool hard_ = false;         ///< the path needs an initial guess: the first step came less than a quarter of it
    bool stuck_ = false;        ///< steps bring fixed coordinates no nearer to their places
    double step_seconds_ = 0;   ///< of the last step
    int steps_left_ = 0;
};

} // namespace taut::impl
