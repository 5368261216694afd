// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include <taut/core/select.hpp>
#include <taut/core/types.hpp>

namespace taut
{

/// The smallest a > 0 at which det(A + a B) = 0 for a triangle with det A > 0; +infinity if it never vanishes.
///
/// det(A + a B) = q a^2 + b a + c is a quadratic with c > 0, so its first positive root is 2c / (sqrt(b^2 - 4qc) - b)
/// where that is positive, and there is none where it is not. For b > 0 the denominator cancels; the conjugate form
/// (sqrt + b) / (-2q) does not. No iterate that stays below the minimum over all elements folds
/// (replaces the backtracking for the lower bound epsilon of paper section 3.2).
template <class T>
T first_flip(const glm::mat<2, 2, T>& A, const glm::mat<2, 2, T>& B)
{
    using std::sqrt;
    const T infinity = T(std::numeric_limits<double>::infinity());
    const T zero = T(0.0);
    const T c = A[0][0] * A[1][1] - A[0][1] * A[1][0];
    const T b = A[0][0] * B[1][1] + B[0][0] * A[1][1] - A[0][1] * B[1][0] - B[0][1] * A[1][0];
    const T q = B[0][0] * B[1][1] - B[0][1] * B[1][0];
    const T discriminant = b * b - T(4.0) * q * c;
    const T root = sqrt(select(discriminant > zero, discriminant, zero));
    const T first = select(b > zero, (b + root) / (T(-2.0) * q), T(2.0) * c / (root - b));
    return select(discriminant >= zero, select(first > zero, first, infinity), infinity);
}

} // namespace taut
