// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <utility>
#include <vector>

#include <taut/deform.hpp>
#include <taut/impl/core/untangle/untangle_refined.hpp>
#include <taut/untangle.hpp>

namespace taut
{

template <class Element>
refined_deformation<Element> deform(queue& q, const mesh<Element>& m, deform_params<Element> params,
                                    const run_limits& limits, const refine_params& refine)
{
    if (!params.targets.empty())
        throw parameter_error("targets", "are of elements, which are to be split; leave it out");
    if (!params.owners.empty()) throw parameter_error("owners", "cells that are not simplices cannot be split");
    if (!params.data.empty()) throw parameter_error("data", "is of elements, which are to be split; leave it out");
    using map = std::vector<vec<Element::dimension>>;
    const auto& points = m.points();
    map x = params.initial.empty() ? map(points.begin(), points.end()) : params.initial;
    const auto pins = params.constraints.on(m);
    pins.impose(x);
    auto split = impl::refine_infeasible(untangle_problem<Element>{m, std::move(x), pins.held()}, refine);
    refined_deformation<Element> found{
        {}, std::move(split.problem.rest), std::move(split.how), std::move(split.cells), split.rounds};
    if (!split.obstacle.empty())
    {
        found.result.report.outcome = outcome::infeasible;
        found.result.report.reason = std::move(split.obstacle);
        return found;
    }
    params.constraints = params.constraints.on(found.refined);
    if (!params.initial.empty())
        params.initial = found.how.extended(std::span<const vec<Element::dimension>>(params.initial));
    found.result = deform(q, found.refined, params, limits);
    return found;
}

template refined_deformation<triangle> deform<triangle>(queue& q, const mesh<triangle>& m,
                                                        deform_params<triangle> params, const run_limits& limits,
                                                        const refine_params& refine);

template refined_deformation<tetrahedron> deform<tetrahedron>(queue& q, const mesh<tetrahedron>& m,
                                                              deform_params<tetrahedron> params,
                                                              const run_limits& limits, const refine_params& refine);

} // namespace taut
