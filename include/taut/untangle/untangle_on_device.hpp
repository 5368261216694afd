// SPDX-License-Identifier: MIT
#pragma once

#include <iterator>
#include <memory>
#include <utility>

#include <taut/untangle/device/operator_stage.hpp>
#include <taut/untangle/untangle_host.hpp>

namespace taut
{

template <class Element>
untangle_result<Element> untangle(const queue& q, const untangle_problem<Element>& problem,
                                  const untangle_params& params)
{
    auto on_device = std::make_unique<operator_stage<Element>>(q);
    if constexpr (Element::dimension == 2)
    {
        auto stages = host_stages(problem.outline_pinned());
        stages.push_back(std::move(on_device));
        return untangle(problem, std::move(stages), params);
    }
    else
    {
        auto stages = solid_host_stages();
        stages.insert(std::next(stages.begin()), std::move(on_device));
        return untangle(problem, std::move(stages), params);
    }
}

} // namespace taut
