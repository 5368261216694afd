// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace taut::solve::impl
{

/// The vector space of std::vector<T> with a fixed number of components: the host model, for tests and small problems.
/// Products are accumulated in double from left to right, so that results are the same on every run.
template <class T>
class basic_host_space
{
public:
    using vector = std::vector<T>;

    explicit basic_host_space(std::size_t components) : components_(components) {}

    std::size_t components() const noexcept { return components_; }

    vector make() const { return vector(components_, T(0)); }

    void copy(const vector& x, vector& y) const { y = x; }

    void axpby(double a, const vector& x, double b, vector& y) const
    {
        if (b == 0) // y may hold anything, NaN included
            for (std::size_t i = 0; i < components_; ++i) y[i] = T(a * double(x[i]));
        else
            for (std::size_t i = 0; i < components_; ++i) y[i] = T(a * double(x[i]) + b * double(y[i]));
    }

    double dot(const vector& x, const vector& y) const
    {
        double sum = 0;
        for (std::size_t i = 0; i < components_; ++i) sum += double(x[i]) * double(y[i]);
        return sum;
    }

    void multi_dot(std::span<const vector* const> left, std::span<const vector* const> right,
                   std::span<double> out) const
    {
        for (std::size_t i = 0; i < left.size(); ++i)
            for (std::size_t j = 0; j < right.size(); ++j) out[i * right.size() + j] = dot(*left[i], *right[j]);
    }

    void linear_combination(std::span<const double> a, std::span<const vector* const> x, vector& out) const
    {
        for (std::size_t i = 0; i < components_; ++i)
        {
            double sum = 0;
            for (std::size_t k = 0; k < x.size(); ++k) sum += a[k] * double((*x[k])[i]);
            out[i] = T(sum);
        }
    }

private:
    std::size_t components_;
};

} // namespace taut::solve::impl
