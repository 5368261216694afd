// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/map/overlap/scaffolded_map.hpp>
#include <taut/impl/core/map/overlap/start_apart.hpp>
#include <taut/impl/core/map/run_result.hpp>
#include <taut/impl/core/map/session/session_run.hpp>
#include <taut/impl/core/map/session/shape_setup.hpp>
#include <taut/impl/core/start/isometric_newton.hpp>
#include <taut/impl/core/untangle/proofs/pinned_boundary.hpp>

namespace taut::impl
{

/// Minimises the energy of a run once more, through maps with a simple boundary: rounds of Newton's method on the map
/// with a scaffold around it, which is rebuilt before each.
class apart_rounds
{
public:
    using map = std::vector<vec2>;

    /// places: a map with fixed coordinates at their targets. Refers to its arguments.
    apart_rounds(const map_run& run, const std::vector<std::vector<idx>>& loops, const map& places)
        : run_(run), scaffolded_(run, loops, places), left_(run.params.solve.max_iterations)
    {
    }

    /// x: without crossings. Afterwards the same holds for the best map so far.
    void run(map x)
    {
        x_ = std::move(x);
        energy_ = energy_start_ = scaffolded_.energy(x_);
        while (rounds_ < most_rounds && left_ > 0 && run_.clock.proceed() && round())
        {
        }
        if (run_.clock.over()) stop_ = solve::impl::stop_of(run_.clock);
    }

    const map& result() const { return x_; }
    int rounds() const { return rounds_; }
    int steps() const { return run_.params.solve.max_iterations - left_; }
    double energy_start() const { return energy_start_; }
    double energy() const { return energy_; }
    double gradient() const { return gradient_; }
    solve::stop stop() const { return stop_; }
    bool places_held() const { return farthest_ < 0; }
    idx farthest() const { return farthest_; }    ///< the vertex that is farthest from its place
    double distance() const { return distance_; } ///< of that one, in normalised units

private:
    static constexpr int most_rounds = 100, most_steps = 20;
    static constexpr double tolerance = 1e-4; ///< of the energy, by it

    /// Returns whether it changed the map.
    bool round()
    {
        auto [plane, how] = scaffolded_.around(x_);
        how.solve.max_iterations = std::min(most_steps, left_);
        if (run_.on_host()) return took(on_host(plane, how), {});
        const run_limits limits{run_.clock.left(), observer()};
        session_result<triangle> moved;
        try
        {
            moved = session_run<triangle>(run_.queue, shape_setup(plane, how, limits)).solve({});
        }
        catch (const mesh_error&)
        {
            // Triangles of the map are flat to the precision of numbers.
        }
        const session_report& r = moved.report;
        if (!moved)
        {
            stop_ = solve::stop::line_search;
            return false;
        }
        if (r.stopped) run_.clock.proceed(); // if it was a limit, what is gained is no measure of convergence
        left_ -= std::min(left_, r.steps);
        return took(std::move(moved.x), r);
    }

    /// Newton's method on the host.
    map on_host(const mesh<triangle>& plane, const deform_params<triangle>& how)
    {
        constexpr double least_gain = 1e-5; // of the energy, by it
        const auto ideal = elements_with_edges<triangle>(how.targets, 1.0, "targets");
        std::vector<target_shape<2>> shapes;
        for (std::size_t c = 0; c < ideal.measure.size(); ++c)
            shapes.push_back({ideal.inverse[c], how.data.weights[c] * ideal.measure[c]});
        const auto springs = directed(how.constraints.springs());
        isometric_newton newton(plane.cells(), std::move(shapes), how.constraints.held());
        map x(plane.points().begin(), plane.points().end());
        double here = newton.value(x, springs);
        for (int k = how.solve.max_iterations; k > 0 && run_.clock.proceed(); --k)
        {
            --left_;
            const double there = newton.step(x, here, springs);
            const double gain = here - there;
            here = there;
            if (!(gain > least_gain * here)) break;
        }
        return x;
    }

    /// Takes a map, of the scaffold, too, if it is better. Returns whether it did, and another round may gain more.
    bool took(map x, const session_report& r)
    {
        ++rounds_;
        x.resize(x_.size());
        const double before = energy_, gap_before = distance_;
        const bool held_before = farthest_ < 0 && rounds_ > 1;
        const double now = scaffolded_.energy(x);
        if (held_before && !(now < before))
        {
            stop_ = solve::stop::decrease;
            return false;
        }
        x_ = std::move(x);
        energy_ = now;
        gradient_ = r.gradient;
        farthest_ = r.farthest;
        distance_ = r.distance;
        const bool small = std::abs(before - now) <= tolerance * std::abs(now);
        if (!small || !(farthest_ < 0 || distance_ > 0.99 * gap_before)) return true;
        stop_ = solve::stop::decrease;
        return false;
    }

    /// Wraps the user's observer, which sees the vertices of the surface alone.
    taut::observer observer() const
    {
        return [this](progress p)
        {
            if (p.coordinates)
                p.coordinates = [this, all = std::move(p.coordinates)]
                {
                    map uv = all();
                    uv.resize(x_.size());
                    for (vec2& point : uv) point /= run_.in.unit;
                    return uv;
                };
            return run_.clock.ask(p);
        };
    }

    const map_run& run_;
    scaffolded_map scaffolded_;
    map x_;
    int left_, rounds_ = 0; ///< steps, rounds
    double energy_ = 0, energy_start_ = 0, gradient_ = 0;
    solve::stop stop_ = solve::stop::iterations;
    idx farthest_ = -1;
    double distance_ = std::numeric_limits<double>::infinity();
};

/// A proof that pins admit no map without overlaps, if there is one: a map that is one-to-one puts neither two vertices
/// in one point nor edges across each other.
inline std::optional<refusal> refuse_meeting_pins(const mesh<triangle>& m, const constraints<triangle>& wanted)
{
    constexpr std::size_t most = 16, tests = 30'000'000; // a few are told; all pairs of many edges would take too long
    std::vector<vec2> x(m.points().size());
    std::vector<char> pinned(x.size(), 0), alone(x.size(), 0);
    std::vector<idx> all;
    for (const auto& [v, pin] : wanted.pins())
    {
        if (pin.held != fixed_marks<2>::every) continue;
        const auto at = static_cast<std::size_t>(v);
        x[at] = pin.value;
        pinned[at] = alone[at] = 1;
        all.push_back(v);
    }
    if (all.size() < 2) return std::nullopt;
    const auto place = [&](idx v)
    { return std::pair(x[static_cast<std::size_t>(v)].x, x[static_cast<std::size_t>(v)].y); };
    std::stable_sort(all.begin(), all.end(), [&](idx a, idx b) { return place(a) < place(b); });
    std::vector<idx> ids;
    for (std::size_t k = 1; k < all.size() && ids.size() < 2 * most; ++k)
        if (place(all[k - 1]) == place(all[k])) ids.insert(ids.end(), {all[k - 1], all[k]});
    if (!ids.empty())
        return refusal{outcome::infeasible,
                       list_ids("pair", "pairs", ids, 2) +
                           " of pinned vertices in one point, where nothing may overlap; move or free one of each",
                       ids};

    auto edges = pinned_edges(m, [&](idx v) { return pinned[static_cast<std::size_t>(v)] != 0; });
    for (const auto& e : edges)
        for (const idx v : e) alone[static_cast<std::size_t>(v)] = 0;
    for (const idx v : all)
        if (alone[static_cast<std::size_t>(v)]) edges.push_back({v, v});
    for_each_meeting(
        edges, x,
        [&](std::size_t i, std::size_t j)
        {
            for (const auto& e : {edges[i], edges[j]}) ids.insert(ids.end(), e.begin(), e.end());
            return ids.size() < 4 * most;
        },
        tests);
    if (ids.empty()) return std::nullopt;
    return refusal{outcome::infeasible,
                   list_ids("pair", "pairs", ids, 4) +
                       " of edges between pinned vertices that meet, where nothing may overlap; move or free a vertex "
                       "of each",
                   ids};
}

/// Returns a solved map without crossings of its boundary: unchanged where it has none, else minimised once more from a
/// map that has none.
inline map_result kept_apart(const map_run& run, map_result r)
{
    if (!r) return r;
    const auto loops = boundary_loops(run.in.surface, run.in.sides);
    overlap_report& told = r.report.overlap.emplace();
    told.before = count_boundary_crossings(loops, r.uv);
    run.clock.spent(&map_seconds::overlap);
    r.report.seconds = run.clock.seconds;
    if (told.before.pairs == 0 && !run.on_host()) return r;
    told.energy_before = r.report.solve.value;
    start_map start = start_apart(run, loops);
    run.clock.stages.add({.stage = "start", .vertices = run.vertices()});
    if (start.uv.empty())
        return refused(std::move(r), {outcome::gave_up, "no map was found whose boundary does not cross itself", {}});

    apart_rounds rounds(run, loops, r.uv);
    rounds.run(start.uv);
    told.rounds = rounds.rounds();
    run.clock.stages.add({.stage = "keep apart",
                          .vertices = run.vertices(),
                          .iterations = rounds.steps(),
                          .energy_before = rounds.energy_start(),
                          .energy_after = rounds.energy(),
                          .stop = std::string(to_string(rounds.stop()))});
    run.clock.spent(&map_seconds::overlap);
    r.report.seconds = run.clock.seconds;
    auto& solved = r.report.solve;
    solved.iterations += rounds.steps();
    solved.stop = rounds.stop();
    if (rounds.rounds() == 0 && !run.held.marks().empty())
        return refused(std::move(r), {outcome::gave_up,
                                      "no path was found from a map whose boundary does not cross itself to the fixed "
                                      "vertices",
                                      {}});
    if (!rounds.places_held())
        return refused(std::move(r), {outcome::gave_up,
                                      "without crossings of the boundary vertex " + std::to_string(rounds.farthest()) +
                                          " came no "
                                          "nearer to its place than " +
                                          std::to_string(rounds.distance() / run.in.unit),
                                      {rounds.farthest()}});
    r.uv = restored(run, rounds.result(), vec2(0), r.uv);
    solved.value = rounds.energy();
    solved.value_start = rounds.energy_start();
    solved.gradient_norm = rounds.gradient();
    solved.history.clear();
    solved.capping.clear();
    r.report.start = std::move(start);
    r.report.flips = certify<2>(run.in.surface.cells(), r.uv, run.in.ideal.measure);
    return r;
}

/// Counts the crossings of a map after its placement, in the user's units.
inline map_result certified_apart(const map_run& run, map_result r)
{
    if (!r) return r;
    r.report.overlap->crossings = boundary_crossings(boundary_loops(run.in.surface, run.in.sides), r.uv);
    if (r.report.overlap->crossings == 0) return r;
    return refused(std::move(r), {outcome::gave_up, "rounding lets the boundary of the map cross itself", {}});
}

} // namespace taut::impl
