// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace taut::test
{

/// A = vectors diag(values) vectors^T, values ascending.
struct symmetric_eigen
{
    Eigen::VectorXd values;
    Eigen::MatrixXd vectors;

    /// A with negative eigenvalues set to 0.
    Eigen::MatrixXd clamped() const { return vectors * values.cwiseMax(0).asDiagonal() * vectors.transpose(); }
    /// A with eigenvalues without their sign.
    Eigen::MatrixXd absolute() const { return vectors * values.cwiseAbs().asDiagonal() * vectors.transpose(); }
};

/// By Eigen, compiled once: every size of a fixed matrix would cost seconds.
symmetric_eigen decompose(const Eigen::MatrixXd& A);

} // namespace taut::test
