// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>

#include <taut/impl/core/untangle/device/multigrid_newton.hpp>
#include <taut/impl/core/untangle/device/operator_stage.hpp>
#include <taut/impl/core/untangle/element_newton.hpp>
#include <taut/untangle.hpp>

namespace taut::impl
{

/// Newton's method by multigrid on a device. Small planar meshes use the direct solver of the host, which is as fast
/// there and needs no kernels.
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

} // namespace taut::impl
