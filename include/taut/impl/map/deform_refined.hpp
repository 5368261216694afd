// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <utility>
#include <vector>

#include <taut/impl/map/deform.hpp>
#include <taut/impl/untangle/untangle_refined.hpp>

namespace taut::impl
{

/// Result of deform() with refinement: the deformation, and the refined mesh.
template <class Element>
struct refined_deformation
{
    session_result<Element> result; ///< deformation of the refined mesh
    mesh<Element> refined;          ///< the vertices of the mesh first, in their order
    impl::subdivision how;          ///< subdivision of the mesh; empty: no element was split
    std::vector<idx> cells;         ///< element of the mesh that contains each element of the refined mesh
    int rounds = 0;                 ///< rounds of splits
};

} // namespace taut::impl

namespace taut
{

/// Deforms a mesh after splitting elements where it is proved that the pins admit no map without inverted elements:
/// inner edges between pinned vertices, say, where all corners of an element are pinned so that it is inverted. The
/// boundary is not split. `infeasible`: the proof holds for all splits inside the mesh; reason says which. Throws
/// parameter_error for params with targets, data of elements or owners, which refined elements do not have, and as
/// deform() does.
template <class Element>
impl::refined_deformation<Element> deform(queue& q, const mesh<Element>& m, deform_params<Element> params,
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
    impl::refined_deformation<Element> found{
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

} // namespace taut
