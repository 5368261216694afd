// SPDX-License-Identifier: MIT
#pragma once

#include <iterator>
#include <memory>
#include <utility>

#include <taut/map/separate.hpp>
#include <taut/map/untangle/operator_stage.hpp>
#include <taut/map/untangle/untangle_host.hpp>

namespace taut
{

TAUT_INLINE untangle_result<triangle> untangle(const queue& q, const untangle_problem<triangle>& problem,
                                               const untangle_params& params)
{
    auto stages = host_stages();
    stages.push_back(std::make_unique<operator_stage<triangle>>(q));
    return untangle(problem, std::move(stages), params);
}

TAUT_INLINE untangle_result<tetrahedron> untangle(const queue& q, const untangle_problem<tetrahedron>& problem,
                                                  const untangle_params& params)
{
    auto stages = solid_host_stages();
    stages.insert(std::next(stages.begin()), std::make_unique<operator_stage<tetrahedron>>(q));
    return untangle(problem, std::move(stages), params);
}

} // namespace taut
