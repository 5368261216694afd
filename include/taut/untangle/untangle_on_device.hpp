// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>

#include <taut/untangle/device/lead_stage.hpp>
#include <taut/untangle/device/multigrid_newton.hpp>
#include <taut/untangle/device/operator_stage.hpp>
#include <taut/untangle/untangle_host.hpp>

namespace taut
{

namespace detail
{

/// Newton's steps by multigrid on a device. In the plane small meshes go to the direct solver of the host, which is as
/// quick there and needs no kernels compiled.
template <class Element>
newton_maker<Element> newton_on_device(const queue& q)
{
    return [q, traced = std::shared_ptr<const newton_kernels<Element>>()](
               regularized_problem<Element> problem) mutable -> std::unique_ptr<regularized_newton<Element>>
    {
        if constexpr (Element::dimension == 2)
        {
            constexpr idx few = 4000; // docs/explanation/numerics.md, "Newton's steps"
            if (problem.rest.cell_count() < few) return direct_newton(problem);
        }
        if (!traced) traced = multigrid_newton<Element>::trace(q);
        return std::make_unique<multigrid_newton<Element>>(q, traced, std::move(problem));
    };
}

} // namespace detail

template <class Element>
untangle_result<Element> untangle(const queue& q, const untangle_problem<Element>& problem,
                                  const untangle_params& params)
{
    auto newton = detail::newton_on_device<Element>(q);
    auto on_device = std::make_unique<operator_stage<Element>>(q);
    if constexpr (Element::dimension == 2)
    {
        auto stages = host_stages(problem.outline_pinned());
        stages.push_back(std::move(on_device));
        return untangle(problem, std::move(stages), std::move(newton), params);
    }
    else
    {
        // What the operator solves it solves at once, before kernels of Hessians are compiled, and it leaves little for
        // a proof to look at. Handles of a free surface are led there rather than untangled: that makes no edges that
        // tetrahedra go around more than once.
        untangle_stages<Element> stages;
        stages.push_back(std::make_unique<harmonic_stage<Element>>());
        stages.push_back(std::move(on_device));
        stages.push_back(std::make_unique<proof_stage>());
        stages.push_back(
            std::make_unique<newton_stage<Element>>(newton_stage_params{"newton", untangle_start::harmonic}));
        stages.push_back(std::make_unique<lead_stage<Element>>(q));
        if (!problem.outline_pinned()) std::swap(stages[3], stages[4]);
        return untangle(problem, std::move(stages), std::move(newton), params);
    }
}

} // namespace taut
