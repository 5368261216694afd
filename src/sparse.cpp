// SPDX-License-Identifier: MIT
#include <taut/impl/sparse/assembly_lists.ipp>
#include <taut/impl/sparse/block_assembly.ipp>
#include <taut/impl/sparse/block_matrix.ipp>
#include <taut/impl/sparse/block_transfer.ipp>
#include <taut/impl/sparse/cell_pattern.ipp>
#include <taut/impl/sparse/dense_inverse.ipp>
#include <taut/impl/sparse/elimination_solver.ipp>
#include <taut/impl/sparse/elimination_tree.ipp>
#include <taut/impl/sparse/front_cholesky.ipp>
#include <taut/impl/sparse/multigrid.ipp>
#include <taut/impl/sparse/multigrid_plan.ipp>
#include <taut/impl/sparse/transfer_lists.ipp>
#include <taut/impl/sparse/transfer_weights.ipp>
