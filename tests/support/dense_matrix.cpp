// SPDX-License-Identifier: MIT
#include <support/dense_matrix.hpp>

#include <utility>

namespace taut::test
{

std::vector<double> dense_matrix::operator*(const std::vector<double>& x) const
{
    std::vector<double> y(size_);
    for (std::size_t i = 0; i < size_; ++i)
    {
        long double sum = 0;
        for (std::size_t j = 0; j < size_; ++j) sum += (*this)(i, j) * x[j];
        y[i] = static_cast<double>(sum);
    }
    return y;
}

dense_matrix dense_matrix::inverse() const
{
    dense_matrix a = *this, x(size_);
    for (std::size_t i = 0; i < size_; ++i) x(i, i) = 1;
    for (std::size_t k = 0; k < size_; ++k)
    {
        std::size_t best = k;
        for (std::size_t i = k; i < size_; ++i)
            if (std::abs(a(i, k)) > std::abs(a(best, k))) best = i;
        for (std::size_t j = 0; j < size_; ++j)
        {
            std::swap(a(k, j), a(best, j));
            std::swap(x(k, j), x(best, j));
        }
        const long double pivot = a(k, k);
        for (std::size_t j = 0; j < size_; ++j)
        {
            a(k, j) /= pivot;
            x(k, j) /= pivot;
        }
        for (std::size_t i = 0; i < size_; ++i)
        {
            if (i == k) continue;
            const long double factor = a(i, k);
            for (std::size_t j = 0; j < size_; ++j)
            {
                a(i, j) -= factor * a(k, j);
                x(i, j) -= factor * x(k, j);
            }
        }
    }
    return x;
}

} // namespace taut::test
