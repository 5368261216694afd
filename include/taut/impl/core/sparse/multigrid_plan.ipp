// SPDX-License-Identifier: MIT
#pragma once

#include <numeric>
#include <utility>

#include <taut/impl/core/sparse/multigrid_plan.hpp>

namespace taut::impl
{

void multigrid_params::validate() const
{
    if (!(lambda_max > 0)) throw parameter_error("lambda_max", "must be positive");
    if (!(lambda_ratio > 1)) throw parameter_error("lambda_ratio", "must be more than 1");
    if (dense_enough > dense_limit) throw parameter_error("dense_enough", "must be at most dense_limit");
}

multigrid_plan::multigrid_plan(block_pattern finest, int block_size, std::span<const transfer_weights> interpolations,
                               lane_form lanes, const multigrid_params& how)
    : D(block_size), form(lanes), params(how), active(finest.rows())
{
    params.validate();
    std::iota(active.begin(), active.end(), 0);
    patterns.push_back(std::move(finest));
    for (const auto& P : interpolations)
    {
        if (active.size() * static_cast<std::size_t>(D) <= params.dense_enough) break;
        const transposed_weights t(P);
        patterns.push_back(pattern_of_product(patterns.back(), P, t));
        transfers.emplace_back(patterns[patterns.size() - 2], P, t, patterns.back(), form);
        active.clear();
        for (std::size_t J = 0; J < P.coarse; ++J)
            if (!t[J].empty()) active.push_back(static_cast<idx>(J));
    }
}

} // namespace taut::impl
