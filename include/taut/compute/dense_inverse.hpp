// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

namespace taut::detail
{

/// The inverse of a symmetric positive semi-definite n x n matrix, row by row, on the host. The matrix is scaled to a
/// unit diagonal and shifted by `shift`, ten times more until its Cholesky factorization exists: directions that it
/// does not see get a large, finite answer. Diagonals must be positive. n^3 operations.
inline std::vector<double> dense_inverse(std::vector<double> A, std::size_t n, double shift)
{
    std::vector<double> scale(n);
    for (std::size_t i = 0; i < n; ++i) scale[i] = 1 / std::sqrt(A[i * n + i]);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) A[i * n + j] *= scale[i] * scale[j];

    std::vector<double> L;
    const auto factorize = [&]
    {
        L = A;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j <= i; ++j)
            {
                double s = L[i * n + j] + (i == j ? shift : 0.0);
                for (std::size_t k = 0; k < j; ++k) s -= L[i * n + k] * L[j * n + k];
                if (i == j && !(s > 0.1 * shift)) return false;
                L[i * n + j] = i == j ? std::sqrt(s) : s / L[j * n + j];
            }
        return true;
    };
    // A matrix with entries that are not finite never factorizes; its inverse is taken as 0.
    while (!factorize())
        if ((shift *= 10) > 10) return std::vector<double>(n * n, 0.0);

    // R = L^-1 by rows, then the inverse R' R.
    std::vector<double> R(n * n, 0.0), inverse(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i)
    {
        R[i * n + i] = 1;
        for (std::size_t k = 0; k < i; ++k)
            for (std::size_t j = 0; j <= k; ++j) R[i * n + j] -= L[i * n + k] * R[k * n + j];
        for (std::size_t j = 0; j <= i; ++j) R[i * n + j] /= L[i * n + i];
    }
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t i = 0; i <= k; ++i)
            for (std::size_t j = 0; j <= k; ++j) inverse[i * n + j] += R[k * n + i] * R[k * n + j];
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) inverse[i * n + j] *= scale[i] * scale[j];
    return inverse;
}

} // namespace taut::detail
