// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <taut/impl/core/map/attempt.hpp>
#include <taut/impl/core/map/made_ahead.hpp>
#include <taut/impl/core/untangle/untangle_host.hpp>
#include <taut/untangle.hpp>

namespace taut::impl
{

/// Start by a penalty continuation for pins, from coarse to fine. Springs pull pinned vertices to their targets,
/// stiffer on each finer level and then step by step on the mesh itself, until all of them can be put there without a
/// flip. A boundary that is pinned as a whole is fixed from the beginning, and only inner pins get springs. The energy
/// is a barrier, so all maps on the way are injective, and what is around a pin is dragged along, which ends in better
/// minima than untangling does.
class penalty_continuation
{
public:
    /// run: one with a penalty continuation; referred to.
    explicit penalty_continuation(const map_run& run)
        : run_(run),
          bound_(run.outline_pinned()),
          anchored_(anchors()),
          places_(anchored_.size(), vec2(0)),
          centre_(run.held.centre()),
          levels_(run.in.surface, bound_ ? anchored_ : std::vector<bool>(),
                  {.proceed = [&run] { return run.clock.proceed(); }}, run.params.data,
                  run.held.touched(anchored_.size())),
          pull_(run.held.pull(anchored_))
    {
        run.held.impose(places_, run.in.unit);
        run.clock.spent(&map_seconds::hierarchy);
        run.clock.stages.add({.stage = "hierarchy", .vertices = run.vertices()});
    }

    /// Computes the start; `useless` where there is none.
    run_start make()
    {
        run_start start;
        start.useless = true;
        if (find_infeasibility(run_.held.problem(run_.in.surface, places_))) return start; // as untangling will say
        nested_params descent = descent_of(run_);
        const std::size_t first = descent.first_level(levels_);
        if (levels_.vertices(first) > most_vertices) return start;
        start_map map = first_map(first);
        run_.clock.spent(&map_seconds::start);
        if (!map.flips) return start;
        descent.start_vertices = levels_.vertices(first);
        descent.first_map = [&map](std::size_t) { return std::move(map); };
        descent.springs = [this](std::size_t l) { return springs(l, first_stiffness(l)); };
        using plan = typename level_solver<triangle>::plan;
        const auto form = lane_form::for_device(run_.queue.device());
        made_ahead<plan> plans(first + 1, [&](std::size_t k) { return plan(levels_, first - k, form); });
        const auto take = [&](std::size_t l) { return plans.take(first - l); };

        std::optional<level_solver<triangle>> solver;
        std::vector<vec2> arrival;
        const bool built = build_within(run_.queue, run_.clock,
                                        [&]
                                        {
                                            solver.emplace(run_.queue, levels_, run_.params.energy, run_.params.weights,
                                                           types_of(run_.first_precision()));
                                            solver->warm_up(true);
                                        });
        if (built)
        {
            run_.clock.spent(&map_seconds::device);
            run_.clock.stages.add({.stage = "device", .vertices = run_.vertices()});
            nested_iteration nested(levels_, *solver, descent);
            arrival = nested.run([this](std::size_t l) { return observer_on(run_.clock, l); }, take);
            start.levels = nested.reports();
            run_.clock.stages.append(nested.stages());
            run_.clock.spent(&map_seconds::start);
        }
        if (!arrival.empty())
        {
            level finest(*solver, take(0), arrival, {.held = {}, .springs = springs(0, first_stiffness(0))});
            finest.relax();
            run_.clock.stages.add({.stage = "prepare", .vertices = run_.vertices()});
            draw(finest, start);
        }
        start.stopped = !run_.clock.proceed();
        return start;
    }

private:
    using level = typename level_solver<triangle>::level;

    std::vector<bool> anchors() const
    {
        std::vector<bool> flags(run_.in.surface.points().size(), false);
        if (bound_)
            for (const auto& loop : boundary_loops(run_.in.surface, run_.in.sides))
                for (const idx v : loop) flags[static_cast<std::size_t>(v)] = true;
        return flags;
    }

    /// Total stiffness of all springs, in units of a mean energy per squared half of the map's size.
    static double first_stiffness(std::size_t l) { return 256 / std::pow(growth, static_cast<double>(l)); }

    /// Targets in the numbering of a level, relative to the centre.
    std::vector<directed_spring<2>> springs(std::size_t l, double stiffness) const
    {
        const auto there = levels_.places(l);
        auto all = pull_;
        for (auto& s : all)
        {
            s.target -= centre_;
            s.stiffness *= stiffness / (static_cast<double>(pull_.size()) * reach_ * reach_);
        }
        const auto asked = run_.held.beyond_pins(centre_).springs;
        all.insert(all.end(), asked.begin(), asked.end());
        for (auto& s : all) s.vertex = there[static_cast<std::size_t>(s.vertex)];
        std::erase_if(all, [](const auto& s) { return s.vertex < 0; });
        return all;
    }

    /// Map of a level with fixed anchors, or, without any, as near to the pins as a similarity brings it.
    start_map first_map(std::size_t l)
    {
        const mesh<triangle> surface = levels_.level(l);
        const auto there = levels_.places(l);
        start_map map;
        if (bound_)
            map.uv = within_outline(surface, there);
        else
            map.uv = robust_start(surface, descent_of(run_).start).uv;
        origins_.assign(there.size(), vec2(0));
        for (std::size_t v = 0; v < there.size(); ++v)
            if (there[v] >= 0) origins_[v] = map.uv[static_cast<std::size_t>(there[v])];
        if (!bound_) run_.held.bring_near(origins_);
        for (std::size_t v = 0; v < there.size(); ++v)
            if (there[v] >= 0) map.uv[static_cast<std::size_t>(there[v])] = origins_[v] - centre_;
        reach_ = bounding_square(map.uv).size / 2;
        assess(map, surface, ideal_elements<triangle>(surface));
        run_.clock.stages.add({.stage = "start", .level = l, .vertices = levels_.vertices(l)});
        return map;
    }

    std::vector<vec2> within_outline(const mesh<triangle>& surface, const std::vector<idx>& there) const
    {
        const std::size_t n = surface.points().size();
        untangle_problem<triangle> problem{surface, std::vector<vec2>(n, vec2(0)), fixed_marks<2>(n)};
        for (std::size_t v = 0; v < there.size(); ++v)
        {
            if (!anchored_[v]) continue;
            problem.initial[static_cast<std::size_t>(there[v])] = places_[v];
            problem.held[static_cast<std::size_t>(there[v])] = fixed_marks<2>::every;
        }
        return untangle(problem, {.stages = {"harmonic", "newton"}, .rounds = 1}).map;
    }

    /// Stiffens the springs, with a Newton step each time, until their vertices can be set to their targets. After a
    /// short step, which they have not followed yet, the stiffness is kept.
    void draw(level& finest, run_start& start)
    {
        const solve::params step{.method = solve::method::newton, .max_iterations = 1};
        solve::report steps; // of all springs, one after the other
        bool moves = true;
        int strides = 0;
        double stiffness = first_stiffness(0);
        for (int done = 0; start.useless; ++done)
        {
            auto uv = centred(levels_.order().vertices.undo(finest.download()), -centre_);
            run_.held.impose(uv, run_.in.unit);
            if (certify<2>(run_.in.surface.cells(), uv))
            {
                start.map.uv = std::move(uv);
                start.useless = false;
                break;
            }
            if (strides == most_strides || done == most_steps || !moves || !run_.clock.proceed()) break;
            auto r = finest.minimize(step, {.observer = observer_on(run_.clock, 1)}); // no map of the run yet
            moves = r.iterations > 0;
            if (moves && !(r.history.back().step < followed))
            {
                ++strides;
                finest.set_springs(springs(0, stiffness *= growth));
            }
            steps = done == 0 ? std::move(r) : solve::impl::joined(std::move(steps), std::move(r));
        }
        untangle_stage_report did{stage_of("draw", 0, run_.vertices(), steps)};
        did.cut_by = corners_of(levels_.cells(0), steps.capping, levels_.users(0));
        did.stop = start.useless ? moves ? "iterations" : "line search" : "injective";
        run_.clock.stages.add(did);
        const double before = run_.clock.seconds.untangle;
        run_.clock.spent(&map_seconds::untangle);
        if (start.useless) return;
        assess(start.map, run_.in.surface, run_.in.ideal);
        start.pin_origins = run_.held.pinned_points(origins_);
        start.centre = bounding_square(start.map.uv).centre;
        run_.clock.has_result(true);
        did.seconds = run_.clock.seconds.untangle - before;
        start.untangling.push_back(std::move(did));
    }

    static constexpr std::size_t most_vertices = 12000; // of the first map, which is made on the host
    static constexpr double growth = 4;
    static constexpr double followed = 0.25; // a step that is no shorter
    static constexpr int most_strides = 24;
    static constexpr int most_steps = 40;

    const map_run& run_;
    bool bound_; ///< all of the boundary is pinned
    std::vector<bool> anchored_;
    std::vector<vec2> places_; ///< targets of fixed vertices
    vec2 centre_;
    mesh_levels<triangle> levels_;
    std::vector<directed_spring<2>> pull_;
    double reach_ = 1;          ///< half the size of the first map
    std::vector<vec2> origins_; ///< of all vertices, as far as they are on the first level
};

} // namespace taut::impl
