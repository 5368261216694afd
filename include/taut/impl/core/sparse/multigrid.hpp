// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <taut/impl/core/sparse/block_transfer.hpp>
#include <taut/impl/core/sparse/dense_inverse.hpp>
#include <taut/impl/core/sparse/multigrid_plan.hpp>

namespace taut::impl
{

/// A symmetric geometric multigrid V-cycle as a preconditioner of a symmetric positive semi-definite block matrix: two
/// steps of Chebyshev iteration on block-Jacobi before and after each coarse correction, Galerkin matrices, a dense
/// inverse on the coarsest level. Assemble into matrix(), refresh(), then apply() at will; both only enqueue.
class multigrid
{
public:
    /// type: of matrices and vectors. Throws parameter_error.
    multigrid(queue& q, scalar_type type, multigrid_plan plan);

    block_matrix& matrix() noexcept { return levels_.front().A; }
    const block_matrix& matrix(std::size_t l = 0) const { return levels_[l].A; }
    std::size_t levels() const noexcept { return levels_.size(); }
    bool solves_coarsest() const noexcept { return !coarsest_.empty(); }
    /// Launches of one apply().
    std::size_t launches() const noexcept;

    /// Makes the matrices of all levels follow the values of matrix().
    void refresh();

    /// x = M b, M symmetric and positive definite where the matrix sees anything; b and x differ.
    void apply(const device_vector& b, device_vector& x);

    /// Bytes on the device of matrices, transfers and vectors.
    std::size_t bytes() const;

private:
    struct level
    {
        explicit level(block_matrix matrix) : A(std::move(matrix)), y(A.vector()) {}
        block_matrix A;
        device_vector b, x; ///< right side and solution of coarse levels
        device_vector y;    ///< the smoother's other iterate; between smoothings the residual
    };

    bool is_solved(std::size_t l) const { return l + 1 == levels() && solves_coarsest(); }
    bool is_small(std::size_t l) const { return fused_ && l + 2 == levels(); }

    /// On entry y holds the smoother's first step from zero.
    void cycle(std::size_t l, const device_vector& b, device_vector& x);

    void cycle_small(const device_vector& b, device_vector& x);

    std::vector<level> levels_;
    std::vector<block_transfer> transfers_;
    impl::dense_inverse coarsest_;
    double first_, momentum_, second_;
    bool fused_ = false;
    impl::late_kernel small_cycle_;
};

} // namespace taut::impl
