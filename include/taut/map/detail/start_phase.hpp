// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <taut/map/detail/parameterization_start.hpp>
#include <taut/map/detail/run_surface.hpp>
#include <taut/measure/describe_defects.hpp>
#include <taut/mesh/describe.hpp>
#include <taut/solve/run_limits.hpp>
#include <taut/untangle/untangle.hpp>

namespace taut::detail
{

/// What became of a start.
enum class start_outcome
{
    ready,   ///< report.start is injective
    refused, ///< it is not; the report says why
    useless  ///< it is not, and nothing binds the run to the coordinates given: another start is better
};

/// The phase of parameterize() that makes a start on the mesh itself: a map that obeys the constraints, untangled where
/// that flipped something. A coarse start does without it.
template <class Element>
class start_phase
{
public:
    /// Refers to its arguments.
    start_phase(queue& q, const run_surface& prepared, run_limits& limits, map_report& report)
        : queue_(q), in_(prepared), limits_(limits), report_(report)
    {
    }

    start_outcome run(const parameterize_params& params)
    {
        make(params);
        report_.seconds.start += limits_.lap();
        if (start().flips) return start_outcome::ready;
        if (!in_.held.constrained() && params.initial.empty()) return refuse();
        const start_outcome r = untangle_start(params);
        report_.seconds.untangle += limits_.lap();
        return r;
    }

private:
    start_map& start() { return report_.start; }

    void make(const parameterize_params& params)
    {
        // Where the constraints leave the boundary free, the best map without them is nearest to the best with them.
        const bool draft = in_.held.constrained() && params.initial.empty() && params.boundary == boundary_mode::free &&
                           !in_.held.outline_pinned(in_.surface, in_.sides);
        if (!draft || !make_without_constraints(params))
        {
            limits_.check();
            auto p = params;
            p.barycentric.proceed = [this] { return limits_.proceed(); };
            start() = parameterization_start(in_.surface, in_.ideal, in_.sides, p, in_.unit, report_.notes);
        }
        if (!in_.held.constrained()) return;
        in_.held.bring_near(start().uv);
        report_.pin_origins = in_.held.pinned_points(start().uv);
        draft_ = start().uv;
        in_.held.impose(start().uv);
        start().assess(in_.surface, in_.ideal);
    }

    /// Whether there is one.
    bool make_without_constraints(parameterize_params p)
    {
        p.constraints = {};
        p.placement = placement::as_solved;
        p.solve.stopping.gradient_tolerance = std::max(1e-3, p.solve.stopping.gradient_tolerance);
        p.time_limit = limits_.left();
        p.observer = [this](solve::progress now)
        {
            now.level = std::max(now.level, 1); // it is not the map that was asked for
            now.seconds = limits_.total();
            return limits_.ask(now);
        };
        auto free = parameterize<Element>(queue_, in_.surface, p); // found when it is instantiated
        if (free) start().uv = std::move(free.uv);
        return static_cast<bool>(free);
    }

    start_outcome untangle_start(const parameterize_params& params)
    {
        auto how = params.untangling;
        how.time_limit = limits_.left();
        how.observer = [this](const solve::progress&)
        { return limits_.ask({.seconds = limits_.total(), .iterate = false}); };
        auto problem = in_.held.problem(in_.surface, start().uv);
        if (!draft_.empty() && certify<2>(in_.surface.cells(), draft_)) problem.draft = std::move(draft_);
        const bool bound = in_.held.constrained() || params.boundary == boundary_mode::fixed;
        limits_.has_result(bound); // the best map, even with defects
        auto found = untangle(queue_, problem, how);
        report_.untangling = std::move(found.stages);
        const std::string before = "the start had " + describe_defects<Element>(start().flips) + "; ";
        if (!bound && !found)
        {
            report_.notes.push_back(before + "another start was made");
            return start_outcome::useless;
        }
        report_.notes.push_back(before + (found ? "it was untangled" : "untangling failed"));
        start().uv = std::move(found.map);
        start().assess(in_.surface, in_.ideal);
        if (found) return start().flips ? start_outcome::ready : refuse();
        const bool proved = found.outcome == untangle_outcome::infeasible;
        report_.outcome = proved ? outcome::infeasible : outcome::gave_up;
        report_.reason = std::move(found.reason);
        report_.ids = std::move(found.ids);
        return start_outcome::refused;
    }

    start_outcome refuse()
    {
        report_.refuse("the start map", start().flips);
        return start_outcome::refused;
    }

    queue& queue_;
    const run_surface& in_;
    run_limits& limits_;
    map_report& report_;
    std::vector<vec2> draft_; // the start before pinned vertices were put to their places
};

} // namespace taut::detail
