// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <taut/map/branch_points.hpp>
#include <taut/map/coarse_to_fine.hpp>
#include <taut/map/held_coordinates.hpp>
#include <taut/map/parameterization_start.hpp>
#include <taut/map/separate.hpp>
#include <taut/map/stopwatch.hpp>
#include <taut/map/untangle/untangle.hpp>

namespace taut
{

namespace detail
{

/// One run of parameterize(): the phases in their order. Inside, lengths are those of the surface times a power of two
/// (unit_scale), so that nothing overflows; undoing that is exact.
class parameterization
{
public:
    parameterization(queue q, const mesh<triangle>& m, const parameterize_params& p)
        : queue_(std::move(q)), unit_(unit_scale(m)), mesh_(scaled(m, unit_)), params_(p), counters_(queue_.counters())
    {
        params_.validate();
    }

    map_result run()
    {
        const auto sides = facets(mesh_);
        validate(mesh_, sides, {.one_boundary = !params_.holes});
        ideal_.emplace(mesh_);
        held_.emplace(mesh_, sides, params_, unit_);
        report().seconds.setup += watch_.lap();
        if (params_.uses_levels())
        {
            levels_.emplace(mesh_, held_->pinned());
            report().seconds.hierarchy = watch_.lap();
        }
        coarse_ = starts_coarse();
        if (!coarse_) make_start(sides);
        if (report().reason.empty()) optimize(sides);
        subtract_counters();
        for (auto* uv : {&result_.uv, &report().start.uv})
            for (vec2& p : *uv) p /= unit_;
        return std::move(result_);
    }

private:
    static mesh<triangle> scaled(const mesh<triangle>& m, double unit)
    {
        auto points = m.points();
        for (vec3& p : points) p *= unit;
        return {std::move(points), m.cells()};
    }

    map_report& report() { return result_.report; }

    bool starts_coarse() const
    {
        if (!levels_ || !params_.initial.empty() || held_->constrained()) return false;
        return params_.first == start_method::coarse || params_.first == start_method::automatic;
    }

    bool proceed() { return in_time() && ask({.seconds = watch_.total(), .iterate = false}); }

    bool in_time() const { return watch_.total() < params_.time_limit.count(); }

    /// Who has once said no is not asked again, whatever the level.
    bool ask(const solve::progress& p)
    {
        stopped_ = stopped_ || (params_.observer && !params_.observer(p));
        return !stopped_;
    }

    void make_start(const facet_table& sides)
    {
        auto p = params_;
        p.start.proceed = [this] { return proceed(); };
        auto& start = report().start;
        // Where the constraints leave the boundary free, the best map without them is nearest to the best with them.
        const bool draft = held_->constrained() && params_.initial.empty() && params_.boundary == boundary_mode::free &&
                           !held_->outline_pinned(mesh_, sides);
        if (!draft || !start_without_constraints())
            start = parameterization_start(mesh_, *ideal_, sides, p, unit_, report().notes);
        if (held_->constrained())
        {
            held_->impose(start.uv);
            start.assess(mesh_, *ideal_);
        }
        report().seconds.start += watch_.lap();
        if (start.flips.flipped > 0 && (held_->constrained() || !params_.initial.empty()))
            if (!untangle_start(sides))
                start = parameterization_start(mesh_, *ideal_, sides, without_initial(p), unit_, report().notes);
        // Sums far from the origin cost digits, most of all in float.
        if (held_->constrained() || !params_.initial.empty()) centre_ = bounding_square(start.uv).centre;
        if (start.flips.flipped == 0) return;
        report().flips = start.flips;
        result_.uv = start.uv;
        if (report().reason.empty()) refuse("the start map");
    }

    /// Whether there is one.
    bool start_without_constraints()
    {
        auto p = params_;
        p.constraints = {};
        p.solve.stopping.gradient_tolerance = std::max(1e-3, p.solve.stopping.gradient_tolerance);
        p.time_limit = left();
        p.observer = [this](solve::progress now)
        {
            now.level = std::max(now.level, 1); // it is not the map that was asked for
            now.seconds = watch_.total();
            return ask(now);
        };
        auto free = parameterization(queue_, mesh_, p).run();
        if (free) report().start.uv = std::move(free.uv);
        return static_cast<bool>(free);
    }

    static parameterize_params without_initial(parameterize_params p)
    {
        p.initial.clear();
        return p;
    }

    /// Makes the start injective if it can, and says why not if it cannot. False if nothing binds a start that did not
    /// come out well, so that another one is better.
    bool untangle_start(const facet_table& sides)
    {
        auto& start = report().start;
        auto how = params_.untangling;
        how.time_limit = left();
        how.observer = [this](const solve::progress&) { return proceed(); };
        auto found = untangle(queue_, held_->problem(mesh_, start.uv), how);
        report().untangling = std::move(found.stages);
        const std::string before = std::to_string(start.flips.flipped) + " triangles of the start were flipped; ";
        const std::size_t branches = found ? branch_points(mesh_, found.map, boundary_flags(sides)).size() : 0;
        const bool bound = held_->constrained() || params_.boundary == boundary_mode::fixed;
        if (!bound && (!found || branches > 0))
        {
            report().notes.push_back(before + "another start was made");
            report().seconds.untangle += watch_.lap();
            return false;
        }
        report().notes.push_back(before + (found ? "it was untangled" : "untangling failed"));
        if (branches > 0)
            report().notes.push_back("the start winds more than once around " + std::to_string(branches) + " vertices");
        start.uv = std::move(found.map);
        start.assess(mesh_, *ideal_);
        report().seconds.untangle += watch_.lap();
        if (found) return true;
        const bool proved = found.outcome == untangle_outcome::infeasible;
        report().outcome = proved ? outcome::infeasible : outcome::gave_up;
        report().reason = std::move(found.reason);
        report().ids = std::move(found.ids);
        return true;
    }

    std::vector<bool> boundary_flags(const facet_table& sides) const
    {
        std::vector<bool> flags(mesh_.points().size(), false);
        for (const auto& loop : boundary_loops(mesh_, sides))
            for (const index v : loop) flags[static_cast<std::size_t>(v)] = true;
        return flags;
    }

    void optimize(const facet_table& sides)
    {
        auto how = params_.precision;
        if (how == precision::automatic)
            how = !queue_.device().has_fp64() ? precision::single : levels_ ? precision::mixed : precision::full;
        solve_in_turns(how);
        if (!certified_ && coarse_)
        {
            report().notes.push_back("the coarse start failed (" + coarse_reason_ + "); a barycentric start was made");
            coarse_ = false;
            arrival_.reset();
            make_start(sides);
            if (!report().reason.empty()) return;
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
        report().seconds.setup += watch_.lap();
        if (report().flips.flipped == 0)
            report().outcome = outcome::valid;
        else
            refuse("the map that was found");
    }

    void refuse(const std::string& map)
    {
        report().ids = report().flips.ids;
        report().reason = map + " has " + std::to_string(report().flips.flipped) + " flipped of " +
                          std::to_string(report().flips.elements) + " triangles, first " +
                          std::to_string(report().ids.empty() ? -1 : report().ids.front());
    }

    /// Solves in a precision, and in double where that did not do.
    void solve_in_turns(precision how)
    {
        const bool chosen = params_.precision == precision::automatic;
        const bool done = attempt(how) && certified_ && (!chosen || accurate());
        if (done || how == precision::full || !queue_.device().has_fp64()) return;
        report().notes.push_back(certified_ ? "float could not reach the tolerance; continued in double"
                                            : "float could not hold this map; repeated in double");
        if (!certified_) arrival_.reset();
        attempt(precision::full);
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
        report().flips = certify<2>(mesh_.cells(), result_.uv, ideal_->measure);
        certified_ = report().flips.flipped == 0 && report().solve.stop != solve::stop::not_finite_start;
    }

    /// False where float, and not the caller, ended the run above the tolerance.
    bool accurate()
    {
        const auto& r = report().solve;
        if (r.stop != solve::stop::decrease && r.stop != solve::stop::line_search && r.stop != solve::stop::barrier)
            return true;
        return r.gradient_norm <= params_.solve.stopping.gradient_tolerance;
    }

    bool solve_in(precision how)
    {
        if (how == precision::full) return levels_ ? solve_levels<double, double>() : solve_alone<double, double>();
        if (how == precision::mixed) return levels_ ? solve_levels<double, float>() : solve_alone<double, float>();
        return levels_ ? solve_levels<float, float>() : solve_alone<float, float>();
    }

    /// Without a hierarchy.
    template <class P, class R>
    bool solve_alone()
    {
        const auto local = std::make_shared<const layout<triangle>>(mesh_, held_->pinned());
        problem<triangle, P, R> f(queue_, local, params_.energy, params_.weights, held_->beyond_pins(centre_));
        auto x = f.make_point();
        f.upload(centred(report().start.uv), x);
        report().seconds.setup += watch_.lap();
        // Drivers compile at the first launch; that is start-up, not solving.
        f.warm_up(x);
        report().seconds.device += watch_.lap();
        report().solve = solve::minimize(f, x, limited(), observer_on(0));
        result_.uv = f.download(x);
        restore(report().start.uv);
        report().seconds.solve += watch_.lap();
        return true;
    }

    template <class P, class R>
    bool solve_levels()
    {
        const auto& numbers = levels_->order().vertices;
        level_solver<P, R> solver(queue_, *levels_, params_.energy, params_.weights);
        solver.warm_up();
        report().seconds.device += watch_.lap();
        if (!arrival_ && !coarse_) arrival_ = numbers.apply(centred(report().start.uv));
        if (!arrival_ && !descend(solver)) return false;
        typename level_solver<P, R>::level finest(solver, 0, *arrival_,
                                                  held_->beyond_pins(centre_).renumbered(numbers));
        report().seconds.setup += watch_.lap();
        if (coarse_) finest.relax();
        report().solve = finest.minimize(limited(), observer_on(0));
        for (int& c : report().solve.capping) c = levels_->order().cells.new_to_old[static_cast<std::size_t>(c)];
        auto uv = finest.download();
        const auto pins = coarse_ ? numbers.undo(*arrival_) : report().start.uv;
        result_.uv = numbers.undo(uv);
        arrival_ = std::move(uv);
        restore(pins);
        report().seconds.solve += watch_.lap();
        return true;
    }

    /// From the coarse start to a map of the mesh in arrival_; false if that failed.
    template <class P, class R>
    bool descend(level_solver<P, R>& solver)
    {
        coarse_to_fine_params p;
        p.start.boundary = params_.start.boundary;
        p.start.fixed_boundary = params_.boundary == boundary_mode::fixed;
        p.start.proceed = [this] { return proceed(); };
        coarse_to_fine<P, R> nested(*levels_, solver, p);
        auto uv = nested.run([this](std::size_t l) { return observer_on(l); });
        report().start = nested.start();
        report().levels = nested.reports();
        coarse_reason_ = uv.empty() ? nested.reason() : "the map that came of it could not be certified";
        report().seconds.start += watch_.lap();
        if (uv.empty()) return false;
        arrival_ = std::move(uv);
        return true;
    }

    /// The user's observer, told where it is; on coarser levels it also keeps the time.
    solve::observer observer_on(std::size_t level)
    {
        return [this, level](solve::progress p)
        {
            p.level = static_cast<int>(level);
            p.seconds = watch_.total();
            return (level == 0 || in_time()) && ask(p);
        };
    }

    solve::params limited() const
    {
        auto p = params_.solve;
        p.stopping.time_limit = std::max(left(), std::chrono::duration<double>(1e-9));
        return p;
    }

    std::chrono::duration<double> left() const
    {
        return std::max(params_.time_limit - std::chrono::duration<double>(watch_.total()),
                        std::chrono::duration<double>(0));
    }

    std::vector<vec2> centred(std::vector<vec2> uv) const
    {
        for (vec2& p : uv) p -= centre_;
        return uv;
    }

    /// Undoes what the solver was free to change without anyone asking for it. start: in the user's order.
    void restore(const std::vector<vec2>& start)
    {
        if (params_.boundary == boundary_mode::free && !held_->constrained() && is_scale_invariant(params_.energy))
            keep_total_area(mesh_, *ideal_, result_.uv);
        for (vec2& p : result_.uv) p += centre_;
        held_->restore(result_.uv, start); // the device may hold positions in float
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
    double unit_;
    mesh<triangle> mesh_;
    parameterize_params params_;
    queue_counters counters_;
    stopwatch watch_;
    std::optional<ideal_elements<triangle>> ideal_;
    std::optional<held_coordinates> held_;
    std::optional<mesh_levels> levels_;
    bool certified_ = false;
    bool stopped_ = false;                     ///< by the observer
    bool coarse_ = false;                      ///< the start comes from coarser levels
    std::string coarse_reason_;                ///< why it does not, or no more
    std::optional<std::vector<vec2>> arrival_; ///< on the finest level, in its numbers, centred
    vec2 centre_{0};
    map_result result_;
};

} // namespace detail

TAUT_INLINE map_result parameterize(queue& q, const mesh<triangle>& m, const parameterize_params& params)
{
    return detail::parameterization(q, m, params).run();
}

} // namespace taut
