// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/types.hpp>

namespace taut
{

/// Squared Frobenius norm |M|_F^2, the sum of the squares of all entries. T may be a traced scalar.
template <int D, class T>
T norm2(const glm::mat<D, D, T>& m)
{
    T sum = glm::dot(m[0], m[0]);
    for (int c = 1; c < D; ++c) sum = sum + glm::dot(m[c], m[c]);
    return sum;
}

} // namespace taut
