// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace taut::test
{

/// A square matrix, for references that are plain to read.
class dense_matrix
{
public:
    explicit dense_matrix(std::size_t size) : size_(size), values_(size * size, 0.0L) {}

    std::size_t size() const { return size_; }
    long double& operator()(std::size_t i, std::size_t j) { return values_[i * size_ + j]; }
    long double operator()(std::size_t i, std::size_t j) const { return values_[i * size_ + j]; }

    // These are compiled once, with optimisations.
    std::vector<double> operator*(const std::vector<double>& x) const;
    /// By Gauss and Jordan, with pivots.
    dense_matrix inverse() const;

private:
    std::size_t size_;
    std::vector<long double> values_;
};

/// What impl::dense_inverse computes: the inverse of the matrix, scaled to a unit diagonal and shifted. Unknowns
/// without a positive diagonal get 0. d: unknown i is one of component i % d, and is stiff against translations of
/// those components that nothing in the matrix holds; 0: there are none.
inline dense_matrix shifted_inverse(const dense_matrix& A, double shift, std::size_t d = 0)
{
    const std::size_t n = A.size();
    std::vector<long double> scale(n);
    for (std::size_t i = 0; i < n; ++i) scale[i] = A(i, i) > 0 ? 1 / std::sqrt(A(i, i)) : 0;
    dense_matrix scaled(n);
    for (std::size_t i = 0; i < n; ++i)
    {
        for (std::size_t j = 0; j < n; ++j) scaled(i, j) = scale[i] * A(i, j) * scale[j];
        scaled(i, i) += shift;
    }
    for (std::size_t c = 0; c < d; ++c)
    {
        long double sum = 0, trace = 0;
        for (std::size_t i = c; i < n; i += d)
        {
            trace += A(i, i);
            for (std::size_t j = c; j < n; j += d) sum += A(i, j);
        }
        if (std::abs(sum) > 1e-5L * trace) continue;
        for (std::size_t i = c; i < n; i += d)
            for (std::size_t j = c; j < n; j += d) scaled(i, j) += 1 / (scale[i] * scale[j] * trace);
    }
    dense_matrix X = scaled.inverse();
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) X(i, j) *= scale[i] * scale[j];
    return X;
}

} // namespace taut::test
