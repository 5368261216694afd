// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <taut/impl/core/error.hpp>
#include <taut/impl/core/name_in.hpp>

namespace taut::dist
{

/// Preconditioners of the Newton systems, of PETSc.
enum class preconditioner
{
    boomeramg,   ///< algebraic multigrid of hypre, HMIS coarsening: copes with slivers and many processes
    gamg,        ///< smoothed aggregation of PETSc, with the rigid motions as near null space
    block_jacobi ///< inverses of the D x D blocks of the diagonal: for tests, and what is left where the others fail
};

/// Distribution of the vertices over processes.
enum class partition
{
    curve,   ///< ranges of the Morton curve, of equal size
    ptscotch ///< parts of the mesh with few edges between them, by PTScotch of PETSc: half the halo of curved shapes
};

} // namespace taut::dist

namespace taut::dist::impl
{

/// Parameters of the linear solver, and of the processes that share its rows.
struct solver_params
{
    dist::preconditioner preconditioner = preconditioner::boomeramg;

    /// Options of PETSc that overrule those of the preconditioner, as `-pc_type gamg -pc_gamg_threshold 0.01`.
    std::string options = {};

    /// Owners of vertices. With PTScotch the last bits of energies depend on the number of processes.
    dist::partition partition = partition::curve;

    /// Throws parameter_error that names the field.
    void validate() const
    {
        if (preconditioner == dist::preconditioner::block_jacobi && !options.empty())
            throw parameter_error("solver.options", "the block diagonal has none; leave them out");
    }
};

} // namespace taut::dist::impl

namespace taut::dist
{

/// Stable name of a preconditioner.
constexpr const char* to_string(preconditioner p)
{
    return taut::impl::name_in<preconditioner::block_jacobi>({"boomeramg", "gamg", "block-jacobi"}, p);
}

/// Stable name of a partition.
constexpr const char* to_string(partition p)
{
    return taut::impl::name_in<partition::ptscotch>({"curve", "ptscotch"}, p);
}

} // namespace taut::dist
