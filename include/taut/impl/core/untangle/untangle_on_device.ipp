// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>

#include <taut/impl/core/untangle/device/loading_stage.hpp>
#include <taut/impl/core/untangle/device/operator_stage.hpp>
#include <taut/impl/core/untangle/stages.hpp>
#include <taut/impl/core/untangle/untangle_host.hpp>
#include <taut/impl/core/untangle/untangle_on_device.hpp>
#include <taut/untangle.hpp>

namespace taut
{

template <class Element>
untangle_result<Element> untangle(const queue& q, const untangle_problem<Element>& problem,
                                  const untangle_params& params, const run_limits& limits)
{
    auto newton = impl::newton_on_device<Element>(q);
    auto on_device = std::make_unique<impl::operator_stage<Element>>(q);
    if constexpr (Element::dimension == 2)
    {
        auto stages = impl::host_stages(problem.outline_pinned());
        stages.push_back(std::move(on_device));
        return untangle(problem, std::move(stages), std::move(newton), params, limits);
    }
    else
    {
        // What the operator solves it solves at once, before kernels of Hessians are compiled, and it leaves little for
        // a proof to look at. Handles of a free surface are led there rather than untangled: that makes no edges that
        // tetrahedra go around more than once.
        impl::untangle_stages<Element> stages;
        stages.push_back(std::make_unique<impl::harmonic_stage<Element>>());
        stages.push_back(std::move(on_device));
        stages.push_back(std::make_unique<impl::proof_stage>());
        stages.push_back(std::make_unique<impl::newton_stage<Element>>());
        stages.push_back(std::make_unique<impl::loading_stage<Element>>(q));
        if (!problem.outline_pinned()) std::swap(stages[3], stages[4]);
        return untangle(problem, std::move(stages), std::move(newton), params, limits);
    }
}

} // namespace taut
