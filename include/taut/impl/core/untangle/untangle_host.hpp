// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/impl/core/measure/describe_defects.hpp>
#include <taut/impl/core/untangle/margin.hpp>
#include <taut/impl/core/untangle/run_stages.hpp>
#include <taut/impl/core/untangle/stages.hpp>
#include <taut/untangle.hpp>

namespace taut::impl
{

/// The determinant with its exact sign.
inline double exact_determinant(const triangle::mapped_corners& x)
{
    return orient(x[0], x[1], x[2]).det;
}

inline double exact_determinant(const tetrahedron::mapped_corners& x)
{
    return orient(x[0], x[1], x[2], x[3]).det;
}

/// Smallest mapped / rest measure of an element over that of the whole.
template <class Element>
double least_relative_det(const untangle_problem<Element>& problem, const std::vector<vec<Element::dimension>>& x)
{
    double least = std::numeric_limits<double>::infinity(), mapped = 0;
    const auto& m = problem.rest;
    const auto shapes = shapes_wanted(problem, 1.0);
    for (std::size_t c = 0; c < m.cells().size(); ++c)
    {
        typename Element::mapped_corners corner;
        for (std::size_t k = 0; k < corner.size(); ++k) corner[k] = x[static_cast<std::size_t>(m.cells()[c][k])];
        const double here = Element::measure_factor * exact_determinant(corner);
        least = std::min(least, here / shapes[c].weight); // the weights sum to 1
        mapped += std::abs(here);
    }
    return mapped > 0 ? least / mapped : 0.0;
}

/// Untangles a map: moves free coordinates until every element is positive, by a sequence of stages
/// (untangle_params::stages), each from its own initial map (stages.hpp). The outcome is injective only with a
/// certificate in exact arithmetic, infeasible only with a proof; a map that was not found to be either comes with the
/// reason and the inverted elements. Fixed coordinates are those of `problem.initial`, bit for bit, in all cases.
/// Throws parameter_error for a problem or parameters that are not valid.
template <class Element>
untangle_result<Element> untangle(const untangle_problem<Element>& problem, impl::untangle_stages<Element> stages,
                                  impl::newton_maker<Element> newton, const untangle_params& params = {},
                                  const run_limits& limits = {})
{
    problem.validate();
    params.validate();
    limits.validate();
    stages = impl::chosen(std::move(stages), params.stages);
    impl::untangle_state<Element> state(problem, limits, std::move(newton));
    untangle_result<Element> result;
    if (state.injective())
        result.stage = "initial";
    else
    {
        impl::infeasibility proof = find_infeasibility(problem);
        if (proof) state.disprove(std::move(proof.proofs.front()));
        state.ended("proofs", proof ? "infeasible" : "");
        if (!proof) result.stage = impl::run_stages(state, stages, params);
        if (state.proof())
        {
            result.outcome = outcome::infeasible;
            result.reason = state.proof()->message;
            result.ids = state.proof()->ids;
        }
    }

    if (state.injective())
    {
        result.outcome = outcome::valid;
        if constexpr (Element::dimension == 2)
            if (result.stage != "initial")
            {
                impl::improve_margin(state, params.tuning.margin_steps);
                state.ended("margin", "");
            }
    }
    result.map = state.best_map();
    result.flips =
        certify<Element::dimension>(problem.rest.cells(), std::span<const vec<Element::dimension>>(result.map), {},
                                    problem.rest.cells().size(), problem.owners);
    if (result.outcome == outcome::gave_up)
    {
        result.ids = result.flips.flipped > 0 ? result.flips.ids : result.flips.branch_ids;
        const std::string left = impl::describe_defects<Element>(result.flips, problem.owners);
        result.reason = state.cancelled() ? "cancelled: " + left
                        : state.stopped() ? "time limit: " + left
                                          : "no stage makes progress: " + left +
                                                (problem.sliding.empty() ? ""
                                                                         : ", with the vertices that slide on the "
                                                                           "boundary or an interface where they are") +
                                                "; a certificate that there is no solution was not found either";
    }
    result.least_relative_det = impl::least_relative_det(problem, result.map);
    result.stages = state.stages();
    result.seconds = state.seconds();
    return result;
}

} // namespace taut::impl
