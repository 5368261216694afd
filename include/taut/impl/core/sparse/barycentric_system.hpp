// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <taut/types.hpp>

namespace taut::impl
{

/// The linear system of a barycentric map, for n free vertices:
///
///     (excess[i] + sum_j w_ij) x_i - sum_j w_ij x_j = rhs[i],    w_ij > 0, excess[i] >= 0
///
/// Row i holds its weights in columns offset[i] .. offset[i + 1]. The diagonal is not stored: as a difference of
/// rounded sums it would lose what `excess`, the total weight towards fixed vertices, keeps to full precision. The
/// pattern is symmetric, the values need not be. A solver is any callable `std::vector<vec2>(barycentric_system)`.
struct barycentric_system
{
    std::vector<idx> offset{0};
    std::vector<idx> column;
    std::vector<double> weight;
    std::vector<double> excess;
    std::vector<vec2> rhs;    ///< sum of weight * position over fixed neighbours
    std::vector<idx> unknown; ///< the vertex of row i

    std::size_t size() const { return excess.size(); }
};

} // namespace taut::impl
