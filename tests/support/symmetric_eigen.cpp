// SPDX-License-Identifier: MIT
#include <support/symmetric_eigen.hpp>

#include <Eigen/Eigenvalues>

namespace taut::test
{

symmetric_eigen decompose(const Eigen::MatrixXd& A)
{
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
    return {eigen.eigenvalues(), eigen.eigenvectors()};
}

} // namespace taut::test
