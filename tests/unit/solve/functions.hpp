// SPDX-License-Identifier: MIT
#pragma once

#include <taut/solve.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

/// Test functions of the solve tests.
namespace functions
{

using taut::solve::host_objective;

/// The chained Rosenbrock function; minimum 0 at (1, ..., 1). The coordinates are scaled: x = scale * z.
inline auto rosenbrock(std::size_t n, double scale = 1, double factor = 1)
{
    return host_objective(n,
                          [n, scale, factor](std::span<const double> x, std::span<double> g)
                          {
                              double value = 0;
                              for (double& component : g) component = 0;
                              for (std::size_t i = 0; i + 1 < n; ++i)
                              {
                                  const double z = x[i] / scale, a = 1 - z, b = x[i + 1] / scale - z * z;
                                  value += a * a + 100 * b * b;
                                  g[i] += factor / scale * (-2 * a - 400 * z * b);
                                  g[i + 1] += factor / scale * 200 * b;
                              }
                              return factor * value;
                          });
}

/// The classic start (-1.2, 1, -1.2, 1, ...).
inline std::vector<double> rosenbrock_start(std::size_t n, double scale = 1)
{
    std::vector<double> x(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = (i % 2 == 0 ? -1.2 : 1) * scale;
    return x;
}

/// offset + 1/2 sum of lambda_i (x_i - 1)^2 with lambda from 1 to `condition`, geometrically.
inline auto quadratic(std::size_t n, double condition, double offset = 0)
{
    return host_objective(n,
                          [n, condition, offset](std::span<const double> x, std::span<double> g)
                          {
                              double value = offset;
                              for (std::size_t i = 0; i < n; ++i)
                              {
                                  const double lambda = std::pow(condition, double(i) / double(n - 1));
                                  g[i] = lambda * (x[i] - 1);
                                  value += (x[i] - 1) * g[i] / 2;
                              }
                              return value;
                          });
}

/// A chain of springs with hardening, sum of d^2/2 + d^4/4 over neighbours, tied to zero and pulled: smooth, convex,
/// with a negative minimum.
inline auto chain(std::size_t n)
{
    return host_objective(n,
                          [n](std::span<const double> x, std::span<double> g)
                          {
                              double value = 0;
                              for (std::size_t i = 0; i < n; ++i)
                              {
                                  value += 5e-3 * x[i] * x[i] - 0.1 * x[i];
                                  g[i] = 1e-2 * x[i] - 0.1;
                              }
                              for (std::size_t i = 0; i + 1 < n; ++i)
                              {
                                  const double d = x[i + 1] - x[i], force = d + d * d * d;
                                  value += d * d / 2 + d * d * d * d / 4;
                                  g[i] -= force;
                                  g[i + 1] += force;
                              }
                              return value;
                          });
}

/// Deterministic noise in [-1, 1].
inline std::vector<double> noise(std::size_t n, unsigned seed = 1)
{
    std::vector<double> x(n);
    for (double& component : x)
    {
        seed = seed * 1664525u + 1013904223u;
        component = double(seed) / double(std::numeric_limits<unsigned>::max()) * 2 - 1;
    }
    return x;
}

/// max |x_i - y_i|, for one assertion in place of many.
inline double distance(const std::vector<double>& x, const std::vector<double>& y)
{
    double largest = 0;
    for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::abs(x[i] - y[i]));
    return largest;
}

/// max |x_i - target|.
inline double distance(const std::vector<double>& x, double target)
{
    return distance(x, std::vector<double>(x.size(), target));
}

/// The largest rise from an earlier value to a later one, relative: 0 for a falling history.
inline double largest_rise(const taut::solve::report& r)
{
    double lowest = std::numeric_limits<double>::infinity(), rise = 0;
    for (const auto& entry : r.history)
    {
        if (entry.value > lowest) rise = std::max(rise, (entry.value - lowest) / std::abs(lowest));
        lowest = std::min(lowest, entry.value);
    }
    return rise;
}

/// A line from a value and a slope function of one variable, for tests of line searches by themselves. It counts.
template <class F, class DF>
class line
{
public:
    line(const F& f, const DF& df, double bound = std::numeric_limits<double>::infinity(), int batch = 1)
        : f_(f), df_(df), bound_(bound), batch_(batch), start_{0, f(0.0), df(0.0)}
    {
    }

    taut::solve::impl::line_point start() const { return start_; }
    double bound() const { return bound_; }
    double noise() const { return 1e-14 * std::abs(start_.value); }
    double ceiling() const { return start_.value + noise(); }
    int batch() const { return batch_; }
    taut::solve::impl::line_point best() const { return best_; }
    bool interrupted() const { return evaluations >= limit; }

    double value(double a)
    {
        longest = std::max(longest, a);
        if (interrupted()) return std::numeric_limits<double>::infinity();
        ++evaluations;
        const double v = taut::solve::impl::finite_or_inf(f_(a));
        if (v < best_.value) best_ = {.step = a, .value = v};
        return v;
    }

    void values(std::span<const double> a, std::span<double> out)
    {
        ++passes;
        for (std::size_t i = 0; i < a.size(); ++i) out[i] = value(a[i]);
    }

    double value_gradient(double a)
    {
        ++gradients;
        at_ = a;
        return value(a);
    }

    double slope() const { return df_(at_); }

    int evaluations = 0, gradients = 0, passes = 0;
    int limit = std::numeric_limits<int>::max(); ///< interrupted after so many
    double longest = 0;

private:
    F f_;
    DF df_;
    double bound_;
    int batch_;
    taut::solve::impl::line_point start_, best_;
    double at_ = 0;
};

} // namespace functions
