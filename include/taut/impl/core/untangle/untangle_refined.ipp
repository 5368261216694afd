// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>

#include <taut/impl/core/core/budget.hpp>
#include <taut/impl/core/untangle/proofs/mending_splits.hpp>
#include <taut/impl/core/untangle/untangle_refined.hpp>
#include <taut/untangle.hpp>

namespace taut
{

template <class Element>
refined_untangling<Element> untangle(const queue& q, const untangle_problem<Element>& problem,
                                     const untangle_params& params, const run_limits& limits,
                                     const refine_params& refine)
{
    limits.validate();
    const impl::budget clock(limits.time_limit);
    bool refused = false;
    auto how = params;
    const auto left = [&]
    {
        run_limits rest{.time_limit = clock.left()};
        if (limits.observer)
            rest.observer = [&](const progress& p)
            {
                refused = refused || !limits.observer(p);
                return !refused;
            };
        return rest;
    };
    auto now = impl::refine_infeasible(problem, refine);
    const auto goes_on = [&](const untangle_result<Element>& found)
    { return found.outcome == outcome::gave_up && !refused && clock.in_time(); };
    const bool splits = refine.rounds > 0;
    if (splits)
    {
        how.stages = impl::quick_stages<Element>(params, {"harmonic", "operator"});
        how.rounds = std::min(2, params.rounds);
    }
    auto found = untangle(q, now.problem, how, left());
    if (found.outcome == outcome::infeasible && !now.obstacle.empty()) found.reason = now.obstacle;
    if (found.outcome != outcome::gave_up || !splits) return {std::move(found), std::move(now)};

    if (Element::dimension == 3 && params.stages.empty() && goes_on(found))
    {
        how.stages = {problem.outline_pinned() ? "newton" : "lead"};
        how.rounds = 1;
        impl::untangle_again(q, now, how, left(), found);
    }
    how.stages = params.stages;
    how.rounds = params.rounds;
    for (int round = now.rounds; goes_on(found) && round < refine.rounds && found.flips.flipped > 0; ++round)
    {
        now.problem.initial = found.map;
        if (!impl::split_further(now, impl::splits_around(now.problem, found.ids).simplices, refine)) break;
        found.flips.flipped = found.flips.branched = now.problem.rest.cells().size();
        impl::take_better(now.problem, now.problem.initial, "initial", found);
        impl::untangle_around(q, now.problem, how, left, found);
    }
    if (found.outcome == outcome::gave_up)
    {
        impl::untangle_again(q, now, how, left(), found);
    }
    found.seconds = clock.total();
    return {std::move(found), std::move(now)};
}

} // namespace taut
