// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/sparse/transfer_lists.hpp>

namespace taut::impl
{

struct multigrid_params
{
    double lambda_max = 3;          ///< bound on the spectrum of B^-1 A, B the block diagonal: corners of an element
    double lambda_ratio = 10;       ///< the smoother damps the spectrum from lambda_max / lambda_ratio on
    std::size_t dense_limit = 600;  ///< unknowns of a coarsest level that is solved directly
    std::size_t dense_enough = 180; ///< unknowns of a level that makes coarser ones superfluous; at most dense_limit

    /// Throws parameter_error with the name of a field outside its domain.
    void validate() const
    {
        if (!(lambda_max > 0)) throw parameter_error("lambda_max", "must be positive");
        if (!(lambda_ratio > 1)) throw parameter_error("lambda_ratio", "must be more than 1");
        if (dense_enough > dense_limit) throw parameter_error("dense_enough", "must be at most dense_limit");
    }
};

/// All of a multigrid that can be made on the host, from the pattern of its finest matrix and the interpolations.
struct multigrid_plan
{
    /// transfer_weights[l]: from level l + 1 to level l, as far as levels are needed; none leaves the smoother and, if
    /// it is small, the dense inverse. The arrays that they refer to may go afterwards. Throws parameter_error.
    multigrid_plan(block_pattern finest, int block_size, std::span<const transfer_weights> interpolations,
                   lane_form lanes, const multigrid_params& how = {})
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

    int D;
    lane_form form;
    multigrid_params params;
    std::vector<block_pattern> patterns;   ///< of the matrices, finest first
    std::vector<transfer_lists> transfers; ///< [l]: between levels l and l + 1
    std::vector<idx> active;               ///< rows of the coarsest level that are not fixed
};

} // namespace taut::impl
