// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <taut/core/detail/made_ahead.hpp>
#include <taut/map/detail/attempt_on_levels.hpp>
#include <taut/untangle/untangle_host.hpp>

namespace taut::detail
{

/// A start for constraints that hold all of the boundary and vertices inside it, from coarse to fine. Every level holds
/// the boundary; springs draw the other vertices to their places, stiffer on each finer level and then step by step on
/// the mesh itself, until they can be put there without a flip. The energy is a barrier, so all maps on the way are
/// injective, and vertices are dragged as a whole with what is around them, which ends in better minima than
/// untangling does.
template <class Element>
class drawn_start
{
public:
    /// Refers to the run.
    explicit drawn_start(const map_run<Element>& run)
        : run_(run),
          outline_(run.in.surface.points().size(), false),
          places_(outline_.size(), vec2(0)),
          levels_(run.in.surface, flagged_outline(), {.proceed = [&run] { return run.clock.proceed(); }},
                  run.params.data, run.held.touched(outline_.size())),
          pull_(run.held.pull(outline_))
    {
        run.held.impose(places_, run.in.unit);
        std::vector<vec2> held;
        for (std::size_t v = 0; v < places_.size(); ++v)
            if (outline_[v]) held.push_back(places_[v]);
        const bounding_square around(held);
        centre_ = around.centre;
        reach_ = around.size / 2;
        run.clock.spent(&map_seconds::hierarchy);
    }

    /// Whether the constraints of a run are of the kind.
    static bool applies(const map_run<Element>& run)
    {
        return run.levels && run.held.constrained() && run.params.boundary == boundary_mode::free &&
               run.params.energy.barrier() && run.held.outline_pinned(run.in.surface, run.in.sides) &&
               (run.params.start == start_method::coarse || run.params.start == start_method::automatic);
    }

    /// The start; `useless` where there is none.
    run_start make()
    {
        run_start start;
        start.useless = true;
        if (find_infeasibility(run_.held.problem(run_.in.surface, places_))) return start; // as untangling will say
        nested_params descent = descent_of(run_);
        descent.first_map = [this](std::size_t l) { return within_outline(l); };
        descent.springs = [this](std::size_t l) { return springs(l, first_stiffness(l)); };
        const std::size_t first = descent.first_level(levels_);
        using plan = typename level_solver<Element>::plan;
        const auto form = lane_form::for_device(run_.queue.device());
        made_ahead<plan> plans(first + 1, [&](std::size_t k) { return plan(levels_, first - k, form); });
        const auto take = [&](std::size_t l) { return plans.take(first - l); };

        std::optional<level_solver<Element>> solver;
        const bool built = build_within(run_.queue, run_.clock,
                                        [&]
                                        {
                                            solver.emplace(run_.queue, levels_, run_.params.energy, run_.params.weights,
                                                           types_of(run_.first_precision()));
                                            solver->warm_up();
                                        });
        if (built) run_.clock.spent(&map_seconds::device);
        nested_iteration nested(levels_, *solver, descent);
        const auto arrival = built ? nested.run([this](std::size_t l) { return observer_on(run_.clock, l); }, take)
                                   : std::vector<vec2>();
        start.levels = nested.reports();
        run_.clock.spent(&map_seconds::start);
        if (!arrival.empty())
            draw({*solver, take(0), arrival, {.held = {}, .springs = springs(0, first_stiffness(0))}},
                 solver->energy_at_rest(), start);
        start.stopped = !run_.clock.proceed();
        return start;
    }

private:
    using level = typename level_solver<Element>::level;

    const std::vector<bool>& flagged_outline()
    {
        for (const auto& loop : boundary_loops(run_.in.surface, run_.in.sides))
            for (const idx v : loop) outline_[static_cast<std::size_t>(v)] = true;
        return outline_;
    }

    /// Of all springs together, in units of a mean energy a squared half of the outline's size.
    static double first_stiffness(std::size_t level) { return 256 / std::pow(growth, static_cast<double>(level)); }

    /// In the numbers of a level, about the centre.
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
        return all;
    }

    /// A map of a level that obeys the outline alone.
    start_map within_outline(std::size_t l)
    {
        const mesh<triangle> surface = levels_.level(l);
        untangle_problem<triangle> problem{surface, std::vector<vec2>(surface.points().size(), vec2(0)),
                                           held_marks<2>(surface.points().size())};
        const auto there = levels_.places(l);
        for (std::size_t v = 0; v < there.size(); ++v)
        {
            if (!outline_[v]) continue;
            problem.initial[static_cast<std::size_t>(there[v])] = places_[v] - centre_;
            problem.held[static_cast<std::size_t>(there[v])] = held_marks<2>::every;
        }
        start_map map;
        map.uv = untangle(problem, {.stages = {"harmonic", "newton"}, .rounds = 1}).map;
        map.assess(surface, ideal_elements<triangle>(surface));
        origins_.assign(there.size(), vec2(0));
        for (std::size_t v = 0; v < there.size(); ++v)
            if (there[v] >= 0) origins_[v] = map.uv[static_cast<std::size_t>(there[v])] + centre_;
        return map;
    }

    /// Stiffens the springs until what they draw can be put to its place.
    void draw(level finest, double base, run_start& start)
    {
        solve::params some{.method = solve::method::newton};
        some.stopping = {.decrease_tolerance = 5e-3, .decrease_count = 1, .max_iterations = 3};
        some.stopping.base = base;
        untangle_stage_report did{"draw"};
        finest.relax();
        double stiffness = first_stiffness(0);
        for (int stride = 0; run_.clock.proceed(); ++stride, stiffness *= growth)
        {
            auto uv = centred(levels_.order().vertices.undo(finest.download()), -centre_);
            run_.held.impose(uv, run_.in.unit);
            if (certify<2>(run_.in.surface.cells(), uv))
            {
                start.map.uv = std::move(uv);
                start.useless = false;
                break;
            }
            if (stride == strides) return;
            if (stride > 0) finest.set_springs(springs(0, stiffness));
            did.iterations += finest.minimize(some, observer_on(run_.clock, 1)).iterations; // no map of the run yet
        }
        if (start.useless) return;
        start.map.assess(run_.in.surface, run_.in.ideal);
        start.pin_origins = run_.held.pinned_points(origins_);
        start.centre = bounding_square(start.map.uv).centre;
        run_.clock.has_result(true);
        run_.clock.spent(&map_seconds::untangle);
        did.seconds = run_.clock.seconds.untangle;
        start.untangling.push_back(std::move(did));
    }

    static constexpr double growth = 4;
    static constexpr int strides = 14; // with stiffer springs rounding would decide

    const map_run<Element>& run_;
    std::vector<bool> outline_;
    std::vector<vec2> places_; ///< where vertices are held
    mesh_levels<Element> levels_;
    std::vector<directed_spring<2>> pull_;
    vec2 centre_{0};
    double reach_ = 1;
    std::vector<vec2> origins_; ///< of all vertices, as far as they are on the first level
};

} // namespace taut::detail
