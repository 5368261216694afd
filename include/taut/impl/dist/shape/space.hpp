// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <taut/impl/dist/processes/fixed_sum.hpp>

namespace taut::dist::impl
{

/// Vectors of D numbers at each vertex, every process with those of its own; a model of solve::vector_space. Many
/// products take one reduction; they are the same bits on all processes, and differ by rounding between numbers of
/// processes.
class dist_space
{
public:
    using vector = std::vector<double>;

    /// n: numbers of this process.
    dist_space(communicator all, std::size_t n) : all_(std::move(all)), n_(n) {}

    std::size_t size() const { return n_; }
    vector make() const { return vector(n_, 0.0); }
    void copy(const vector& x, vector& y) const { y = x; }

    void axpby(double a, const vector& x, double b, vector& y) const
    {
        if (b == 0)
            for (std::size_t i = 0; i < n_; ++i) y[i] = a * x[i];
        else
            for (std::size_t i = 0; i < n_; ++i) y[i] = a * x[i] + b * y[i];
    }

    double dot(const vector& x, const vector& y) const
    {
        const vector* const left[] = {&x};
        const vector* const right[] = {&y};
        double product = 0;
        multi_dot(left, right, std::span(&product, 1));
        return product;
    }

    void multi_dot(std::span<const vector* const> left, std::span<const vector* const> right,
                   std::span<double> out) const
    {
        shared_sums sums(left.size() * right.size());
        for (std::size_t i = 0; i < left.size(); ++i)
            for (std::size_t j = 0; j < right.size(); ++j) sums[i * right.size() + j].add(local(*left[i], *right[j]));
        const auto totals = sums.totals(all_);
        std::copy(totals.begin(), totals.end(), out.begin());
    }

    void linear_combination(std::span<const double> a, std::span<const vector* const> x, vector& out) const
    {
        if (x.empty()) return out.assign(n_, 0.0);
        for (std::size_t i = 0; i < n_; ++i)
        {
            double sum = 0;
            for (std::size_t k = 0; k < x.size(); ++k) sum += a[k] * (*x[k])[i];
            out[i] = sum;
        }
    }

private:
    double local(const vector& x, const vector& y) const
    {
        double sum = 0;
        for (std::size_t i = 0; i < n_; ++i) sum += x[i] * y[i];
        return sum;
    }

    communicator all_;
    std::size_t n_;
};

} // namespace taut::dist::impl
