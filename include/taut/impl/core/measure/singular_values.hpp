// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>

#include <taut/types.hpp>

namespace taut::impl
{

/// Singular values of a small matrix, largest first: how far it stretches in its principal directions.
/// One-sided Jacobi: columns are rotated until they are orthogonal, then their lengths are the values. Small values
/// keep their relative accuracy, which the square roots of the eigenvalues of M^T M do not.
template <int D>
std::array<double, D> singular_values(mat<D> M)
{
    constexpr int sweeps = 30; // quadratic convergence: 2 for D = 2, about 6 for D = 3
    for (int sweep = 0; sweep < sweeps; ++sweep)
    {
        bool rotated = false;
        for (int p = 0; p < D; ++p)
            for (int q = p + 1; q < D; ++q)
            {
                const double a = glm::dot(M[p], M[p]);
                const double b = glm::dot(M[q], M[q]);
                const double c = glm::dot(M[p], M[q]);
                if (!(std::abs(c) > std::numeric_limits<double>::epsilon() * std::sqrt(a) * std::sqrt(b))) continue;
                rotated = true;
                // The smaller root t of t^2 + 2 zeta t - 1 = 0 makes the new columns orthogonal.
                const double zeta = (b - a) / (2 * c);
                const double t = std::copysign(1.0, zeta) / (std::abs(zeta) + std::sqrt(1 + zeta * zeta));
                const double cosine = 1 / std::sqrt(1 + t * t);
                const auto column = M[p];
                M[p] = cosine * (column - t * M[q]);
                M[q] = cosine * (t * column + M[q]);
            }
        if (!rotated) break;
    }
    std::array<double, D> s;
    for (int k = 0; k < D; ++k) s[static_cast<std::size_t>(k)] = glm::length(M[k]);
    std::sort(s.begin(), s.end(), std::greater<>());
    return s;
}

} // namespace taut::impl
