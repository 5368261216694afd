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

} // namespace taut::dist

namespace taut::dist::impl
{

/// Parameters of the linear solver.
struct solver_params
{
    dist::preconditioner preconditioner = preconditioner::boomeramg;

    /// Options of PETSc that overrule those of the preconditioner, as `-pc_type gamg -pc_gamg_threshold 0.01`.
    std::string options = {};

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

} // namespace taut::dist
