// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <taut/map/detail/attempt_in_turns.hpp>
#include <taut/map/detail/choose_start.hpp>
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
/// The map is in the lengths of the run. draft: as of free_draft(), or none.
template <class Element>
map_result solved(const map_run<Element>& run, std::vector<vec2> draft)
{
    const run_start start = choose_start(run, std::move(draft));
    if (!start.ready()) return unsolved_result(run, start);
    attempt first = attempt_in_turns(run, start);
    if (first.certified || first.stopped || !start.coarse) return solved_result(run, start, std::move(first));

    run.clock.has_result(false);
    if (!run.clock.proceed()) return stopped_result(run, start, std::move(first));
    const run_start second = second_start(run, start, first);
    if (!second.ready()) return unsolved_result(run, second);
    return solved_result(run, second, attempt_in_turns(run, second));
}

/// Whether the constraints leave the boundary free: the best map without them is then nearest to the best with them.
template <class Element>
bool wants_draft(const map_run<Element>& run)
{
    return run.held.constrained() && run.params.initial.empty() && run.params.boundary == boundary_mode::free &&
           !run.held.outline_pinned(run.in.surface, run.in.sides);
}

<<<<<<< HEAD
/// A map as of a run without the constraints, to begin the run with; none if that has no valid one.
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
                        return run.clock.ask(now);
                    });
    const map_run<Element> free(run.queue, run.in, params, clock);
    map_result draft = solved(free, {});
    return draft ? std::move(draft.uv) : std::vector<vec2>();
}
=======
    map_report& report() { return result_.report; }

    void phases()
    {
        limits_.check();
        if (params_.uses_levels())
        {
            levels_.emplace(in_.surface, in_.held.pinned(),
                            hierarchy_params{.proceed = [this] { return limits_.proceed(); }}, params_.data);
            report().seconds.hierarchy = limits_.lap();
            limits_.check();
        }
        if (make_start()) optimize();
    }

    /// The limits ended the run outside of a minimisation: the best map of by then, if there is one.
    void stop_short()
    {
        if (!certified_ && arrival_)
        {
            const auto start = levels_->order().vertices.undo(*arrival_);
            result_.uv = start;
            restore(start);
        }
        else if (!certified_)
            result_.uv = report().start.uv;
        if (!certified_ && !result_.uv.empty())
        {
            const means e = mean_over<triangle>(in_.surface, in_.ideal, result_.uv,
                                                [this](const element<double, 2>& here) {
                                                    return here.det > 0 ? params_.energy(here)
                                                                        : std::numeric_limits<double>::infinity();
                                                });
            report().solve.value = params_.weights == energy::weighting::measure ? e.measure : e.uniform;
            report().solve.value_start = report().solve.value;
            certify_map();
        }
        report().solve.stop = limits_.reason();
        report().outcome = certified_ ? outcome::valid : outcome::stopped;
        if (certified_) return;
        result_.uv.clear();
        report().reason = limits_.reason() == solve::stop::time ? "the time limit came before there was a map"
                                                                : "stopped before there was a map";
    }

    bool starts_coarse() const
    {
        if (!levels_ || !params_.initial.empty() || in_.held.constrained()) return false;
        return params_.start == start_method::coarse || params_.start == start_method::automatic;
    }

    /// Whether there is a start, or a way to make one on coarser levels.
    bool make_start()
    {
        coarse_ = starts_coarse();
        return coarse_ || make_fine_start();
    }

    /// Whether there is an injective start on the mesh itself.
    bool make_fine_start()
    {
        const auto made = start_phase<Element>(queue_, in_, limits_, report()).run(params_);
        if (made == start_outcome::useless)
        {
            limits_.check();
            params_.initial.clear();
            return make_start();
        }
        const auto& start = report().start;
        // Sums far from the origin cost digits, most of all in float.
        if (in_.held.constrained() || !params_.initial.empty()) centre_ = bounding_square(start.uv).centre;
        if (made == start_outcome::ready)
        {
            limits_.has_result(true);
            limits_.check();
            return true;
        }
        report().flips = start.flips;
        result_.uv = start.uv;
        return false;
    }

    void optimize()
    {
        auto how = params_.precision;
        if (how == precision::automatic)
            how = !queue_.device().has_fp64() ? precision::fp32 : levels_ ? precision::mixed : precision::fp64;
        solve_in_turns(how);
        if (!certified_ && coarse_)
        {
            limits_.has_result(false);
            limits_.check();
            report().notes.push_back("the coarse start failed (" + coarse_reason_ + "); a barycentric start was made");
            coarse_ = false;
            arrival_.reset();
            if (!make_fine_start()) return;
            solve_in_turns(how);
        }
        if (!certified_ && !report().start.uv.empty())
        {
            report().notes.push_back("the minimum that was found is too small or too thin for its precision; the start "
                                     "map is returned");
            result_.uv = report().start.uv;
            report().solve.value = report().solve.value_start;
            certify_map();
        }
        report().seconds.setup += limits_.lap();
        if (report().flips)
            report().outcome = outcome::valid;
        else
            report().refuse("the map that was found", report().flips);
    }

    /// Solves in a precision, and in double where that did not do.
    void solve_in_turns(precision how)
    {
        const bool chosen = params_.precision == precision::automatic;
        const bool done = attempt(how) && certified_ && (!chosen || accurate());
        if (done || how == precision::fp64 || !queue_.device().has_fp64()) return;
        const int left = params_.solve.stopping.max_iterations - report().solve.iterations;
        if (certified_ && left == 0) return;
        report().notes.push_back(certified_ ? "float could not reach the tolerance; continued in double"
                                            : "float could not hold this map; repeated in double");
        if (!certified_) arrival_.reset();
        const bool goes_on = certified_;
        auto before = report().solve;
        if (goes_on) params_.solve.stopping.max_iterations = left; // the limit is one for both
        if (attempt(precision::fp64) && goes_on) report().solve = joined(std::move(before), std::move(report().solve));
    }

    /// Solves in a precision and certifies the map; whether there is one.
    bool attempt(precision how)
    {
        report().precision = how;
        if (!solve_in(how)) return false;
        certify_map();
        return true;
    }

    /// Counts flips of the current map. Not certified either: a map whose energy was never finite.
    void certify_map()
    {
        report().flips = certify<2>(in_.surface.cells(), result_.uv, in_.ideal.measure);
        certified_ = report().flips && report().solve.stop != solve::stop::not_finite_start;
    }

    /// False where float, and not the caller, ended the run above the tolerance.
    bool accurate()
    {
        const auto& r = report().solve;
        if (r.stop != solve::stop::decrease && r.stop != solve::stop::line_search && r.stop != solve::stop::barrier)
            return true;
        return r.gradient_norm <= params_.solve.stopping.gradient_tolerance;
    }

    bool solve_in(precision how) { return levels_ ? solve_levels(types_of(how)) : solve_alone(types_of(how)); }

    /// Without a hierarchy.
    bool solve_alone(const real_types& types)
    {
        const auto local = std::make_shared<layout<triangle>>(in_.surface, in_.held.pinned());
        if (!params_.data.empty())
            local->attach(params_.data.reordered(local->order.cells), permute(in_.surface, local->order));
        map_objective<triangle> f(queue_, local, params_.energy, params_.weights, types, in_.held.beyond_pins(centre_));
        auto x = f.make_point();
        f.upload(centred(report().start.uv), x);
        report().seconds.setup += limits_.lap();
        // Drivers compile at the first launch; that is start-up, not solving.
        {
            const auto asked = ask_between_builds();
            f.warm_up(x);
        }
        report().seconds.device += limits_.lap();
        report().solve = solve::minimize(f, x, limited(), observer_on(0));
        result_.uv = f.download(x);
        restore(report().start.uv);
        report().seconds.solve += limits_.lap();
        return true;
    }

    bool solve_levels(const real_types& types)
    {
        const auto& numbers = levels_->order().vertices;
        if (!arrival_ && !coarse_) arrival_ = numbers.apply(centred(report().start.uv));
        const auto how = descent();
        const std::size_t first = arrival_ ? 0 : how.first_level(*levels_);
        // Plans are made while the driver compiles, and while coarser levels are solved.
        using plan = level_solver<triangle>::plan;
        const auto form = lane_form::for_device(queue_.device());
        made_ahead<plan> plans(first + 1, [&, this](std::size_t k) { return plan(*levels_, first - k, form); });
        const auto take = [&](std::size_t l) { return plans.take(first - l); };

        auto asked = ask_between_builds();
        level_solver solver(queue_, *levels_, params_.energy, params_.weights, types);
        solver.warm_up();
        asked.reset();
        report().seconds.device += limits_.lap();
        limits_.check();
        if (!arrival_)
        {
            nested_iteration nested(*levels_, solver, how);
            auto uv = nested.run([this](std::size_t l) { return observer_on(l); }, take);
            if (!arrive(nested, std::move(uv))) return false;
        }
        level_solver<triangle>::level finest(solver, take(0), *arrival_,
                                             in_.held.beyond_pins(centre_).renumbered(numbers));
        report().seconds.setup += limits_.lap();
        limits_.check();
        if (coarse_ && iterates()) finest.relax();
        report().solve = finest.minimize(limited(), observer_on(0));
        for (int& c : report().solve.capping) c = levels_->order().cells.new_to_old[static_cast<std::size_t>(c)];
        auto uv = finest.download();
        const auto pins = coarse_ ? numbers.undo(*arrival_) : report().start.uv;
        result_.uv = numbers.undo(uv);
        arrival_ = std::move(uv);
        restore(pins);
        report().seconds.solve += limits_.lap();
        return true;
    }

    nested_params descent()
    {
        nested_params p;
        if (!iterates()) p.stopping.max_iterations = 0;
        p.start.boundary = params_.barycentric.boundary;
        p.start.fixed_boundary = params_.boundary == boundary_mode::fixed;
        p.start.proceed = [this] { return limits_.proceed(); };
        return p;
    }

    /// Takes in what a descent came to; false if it failed.
    bool arrive(const nested_iteration& nested, std::vector<vec2> uv)
    {
        report().start = nested.start();
        report().levels = nested.reports();
        coarse_reason_ = uv.empty() ? nested.reason() : "the map that came of it could not be certified";
        report().seconds.start += limits_.lap();
        if (uv.empty()) return false;
        arrival_ = std::move(uv);
        limits_.has_result(true);
        limits_.check();
        return true;
    }

    /// Without iterations the start is returned as it is.
    bool iterates() const { return params_.solve.stopping.max_iterations > 0; }

    /// While it is held, the limits are asked between the kernels that are built.
    std::shared_ptr<void> ask_between_builds()
    {
        queue_.state()->between_builds = [this] { limits_.check(); };
        return {nullptr, [q = queue_](void*) { q.state()->between_builds = nullptr; }};
    }

    /// The user's observer, told where it is; on coarser levels it also keeps the time.
    solve::observer observer_on(std::size_t level)
    {
        return [this, level](solve::progress p)
        {
            p.level = static_cast<int>(level);
            p.seconds = limits_.total();
            return (level == 0 || limits_.in_time()) && limits_.ask(p);
        };
    }

    solve::params limited() const
    {
        auto p = params_.solve;
        p.stopping.time_limit = std::max(limits_.left(), std::chrono::duration<double>(1e-9));
        return p;
    }

    std::vector<vec2> centred(std::vector<vec2> uv) const
    {
        for (vec2& p : uv) p -= centre_;
        return uv;
    }

    /// Whether nothing holds the map.
    bool is_free() const { return params_.boundary == boundary_mode::free && !in_.held.constrained(); }

    /// Brings a free map to its place, or leaves it where it is if rounding would flip a triangle on the way.
    void place()
    {
        if (params_.placement == placement::as_solved) return;
        const double side = params_.placement == placement::unit_square ? in_.unit : 0;
        for (const bool turned : {true, false})
        {
            auto map = in_corner(turned ? turned_up(in_.surface, result_.uv) : result_.uv, side);
            const auto flips = certify<2>(in_.surface.cells(), map.uv, in_.ideal.measure);
            if (!flips) continue;
            result_.uv = std::move(map.uv);
            report().scale = map.scale;
            report().flips = flips;
            return;
        }
        report().notes.push_back("rounding would flip triangles of the map in its place; it stays where it was solved");
    }

    /// Undoes what the solver was free to change without anyone asking for it. start: in the user's order.
    void restore(const std::vector<vec2>& start)
    {
        if (is_free() && is_scale_invariant(params_.energy)) keep_total_area(in_.surface, in_.ideal, result_.uv);
        for (vec2& p : result_.uv) p += centre_;
        in_.held.restore(result_.uv, start); // the device may hold positions in float
    }

    /// Lengths of the user, pins bit for bit; the division is inexact at the ends of the range of double, so what is
    /// valid is certified again.
    void return_to_user_units()
    {
        for (auto* points : {&result_.uv, &report().start.uv, &report().pin_origins})
            for (vec2& p : *points) p /= in_.unit;
        if (!result_.uv.empty()) in_.held.impose(result_.uv, 1);
        if (report().outcome != outcome::valid) return;
        report().flips.take_defects(certify<2>(in_.surface.cells(), result_.uv));
        if (report().flips) return;
        report().outcome = outcome::gave_up;
        report().refuse("the map in the units of the surface, which are too large or small for double precision,",
                        report().flips);
    }

    void subtract_counters()
    {
        auto& used = report().counters;
        used = queue_.counters();
        used.launches -= counters_.launches;
        used.waits -= counters_.waits;
        used.bytes_read -= counters_.bytes_read;
        used.bytes_written -= counters_.bytes_written;
        used.builds -= counters_.builds;
        used.build_seconds -= counters_.build_seconds;
    }

    queue queue_;
    parameterize_params params_;
    queue_counters counters_;
    run_limits limits_;
    run_surface in_;
    std::optional<mesh_levels<triangle>> levels_;
    bool certified_ = false;
    bool coarse_ = false;                      ///< the start comes from coarser levels
    std::string coarse_reason_;                ///< why it does not, or no more
    std::optional<std::vector<vec2>> arrival_; ///< on the finest level, in its numbers, centred
    vec2 centre_{0};
    map_result result_;
};
>>>>>>> 4d8d0b120093ee2cda60a9d70ad4624eb83cfeb8

} // namespace detail

template <class Element>
map_result parameterize(queue& q, const mesh<Element>& m, const parameterize_params& params)
{
    const parameterize_params wanted = detail::validated(params);
    const queue_counters before = q.counters();
    detail::run_clock clock(wanted.time_limit, wanted.observer);
    const detail::run_surface surface(m, wanted);
    const detail::map_run<Element> run(q, surface, wanted, clock);

    std::vector<vec2> draft;
    if (detail::wants_draft(run) && !clock.over()) draft = detail::free_draft(run);
    map_result result = detail::solved(run, std::move(draft));
    result = detail::in_user_units(run, detail::placed(run, std::move(result)));
    result.report.counters = detail::counted_since(before, q.counters());
    return result;
}

} // namespace taut
