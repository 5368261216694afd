// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <taut/impl/core/sparse/transfer_lists.hpp>

namespace taut::impl
{

struct multigrid_params
{
    double lambda_max = 3;          ///< bound on the spectrum of B^-1 A, B the block diagonal: corners of an element
    double lambda_ratio = 10;       ///< the smoother damps the spectrum from lambda_max / lambda_ratio on
    std::size_t dense_limit = 600;  ///< unknowns of a coarsest level that is solved directly
    std::size_t dense_enough = 180; ///< unknowns of a level that makes coarser ones superfluous; at most dense_limit

    /// Throws parameter_error with the name of a field outside its domain.
    void validate() const;
};

/// All of a multigrid that can be made on the host, from the pattern of its finest matrix and the interpolations.
struct multigrid_plan
{
    /// transfer_weights[l]: from level l + 1 to level l, as far as levels are needed; none leaves the smoother and, if
    /// it is small, the dense inverse. The arrays that they refer to may go afterwards. Throws parameter_error.
    multigrid_plan(block_pattern finest, int block_size, std::span<const transfer_weights> interpolations,
                   lane_form lanes, const multigrid_params& how = {});

    int D;
    lane_form form;
    multigrid_params params;
    std::vector<block_pattern> patterns;   ///< of the matrices, finest first
    std::vector<transfer_lists> transfers; ///< [l]: between levels l and l + 1
    std::vector<idx> active;               ///< rows of the coarsest level that are not fixed
};

} // namespace taut::impl
