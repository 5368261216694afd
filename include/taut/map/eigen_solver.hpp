// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#if __has_include(<Eigen/SparseCore>)
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#else
#include <eigen3/Eigen/SparseCholesky>
#include <eigen3/Eigen/SparseLU>
#endif

#include <taut/core/error.hpp>
#include <taut/map/barycentric_system.hpp>

namespace taut
{

/// Solves barycentric systems with Eigen: LDL^T where the weights are symmetric, else LU; one step of refinement.
/// The only header that needs Eigen, and no other header includes it; elimination_solver does without.
class eigen_solver
{
public:
    /// Throws `error` if the factorization fails: some unknowns have no path to a fixed vertex.
    std::vector<vec2> operator()(const barycentric_system& system) const
    {
        const matrix A = assemble(system);
        const auto n = static_cast<Eigen::Index>(system.size());
        if (n == 0) return {};
        Eigen::MatrixX2d b(n, 2);
        for (Eigen::Index i = 0; i < n; ++i)
        {
            const vec2& r = system.rhs[static_cast<std::size_t>(i)];
            b.row(i) << r.x, r.y;
        }
        const matrix transposed = A.transpose();
        const bool symmetric = (A - transposed).norm() == 0;
        const Eigen::MatrixX2d x =
            symmetric ? solve<Eigen::SimplicialLDLT<matrix>>(A, b) : solve<Eigen::SparseLU<matrix>>(A, b);
        std::vector<vec2> result;
        result.reserve(system.size());
        for (Eigen::Index i = 0; i < n; ++i) result.emplace_back(x(i, 0), x(i, 1));
        return result;
    }

private:
    using matrix = Eigen::SparseMatrix<double>;

    static matrix assemble(const barycentric_system& system)
    {
        std::vector<Eigen::Triplet<double>> entries;
        entries.reserve(system.column.size() + system.size());
        for (std::size_t i = 0; i < system.size(); ++i)
        {
            const auto row = static_cast<index>(i);
            double diagonal = system.excess[i];
            for (index k = system.offset[i]; k < system.offset[i + 1]; ++k)
            {
                const double w = system.weight[static_cast<std::size_t>(k)];
                diagonal += w;
                entries.emplace_back(row, system.column[static_cast<std::size_t>(k)], -w);
            }
            entries.emplace_back(row, row, diagonal);
        }
        const auto n = static_cast<Eigen::Index>(system.size());
        matrix A(n, n);
        A.setFromTriplets(entries.begin(), entries.end());
        return A;
    }

    template <class Factorization>
    static Eigen::MatrixX2d solve(const matrix& A, const Eigen::MatrixX2d& b)
    {
        Factorization factors(A);
        if (factors.info() != Eigen::Success) throw error("the barycentric system is singular");
        Eigen::MatrixX2d x = factors.solve(b);
        x += factors.solve(b - A * x);
        return x;
    }
};

} // namespace taut
