// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <taut/impl/core/types.hpp>

namespace taut::impl
{

/// A square matrix of D x D blocks by rows (CSR): block k of row r, in column columns[k], for k = offsets[r] ..
/// offsets[r + 1] - 1, columns ascending; entry (i, j) of a block is blocks[k][j][i], as GLM has it.
template <int D>
struct block_rows
{
    std::vector<idx> offsets, columns;
    std::vector<mat<D>> blocks;
};

} // namespace taut::impl
