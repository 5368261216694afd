// SPDX-License-Identifier: MIT
#include <taut/impl/core/sparse/block_assembly.ipp>
#include <taut/impl/core/sparse/block_matrix.ipp>
#include <taut/impl/core/sparse/block_transfer.ipp>
#include <taut/impl/core/sparse/cell_pattern.ipp>
#include <taut/impl/core/sparse/dense_inverse.ipp>
#include <taut/impl/core/sparse/elimination_solver.ipp>
#include <taut/impl/core/sparse/elimination_tree.ipp>
#include <taut/impl/core/sparse/front_cholesky.ipp>
#include <taut/impl/core/sparse/multigrid.ipp>
#include <taut/impl/core/sparse/multigrid_plan.ipp>
#include <taut/impl/core/sparse/transfer_lists.ipp>
#include <taut/impl/core/sparse/transfer_weights.ipp>
