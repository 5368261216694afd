// SPDX-License-Identifier: MIT
#pragma once

#include <iterator>
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
            constexpr idx few = 4000; // docs/numerics.md, "Newton's steps"
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
        // What the operator solves it solves at once, before kernels of Hessians are compiled. Handles of a free
        // surface are led there rather than untangled: that makes no edges that tetrahedra go around more than once.
        std::unique_ptr<untangle_stage<Element>> inner[] = {
            std::move(on_device),
            std::make_unique<newton_stage<Element>>(newton_stage_params{"newton", untangle_start::harmonic}),
            std::make_unique<lead_stage<Element>>(q)};
        if (!problem.outline_pinned()) std::swap(inner[1], inner[2]);
        auto stages = solid_host_stages();
        stages.insert(std::next(stages.begin()), std::make_move_iterator(std::begin(inner)),
                      std::make_move_iterator(std::end(inner)));
        return untangle(problem, std::move(stages), std::move(newton), params);
    }
}

} // namespace taut
