// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/error.hpp>
#include <taut/impl/solve/host_space.hpp>
#include <taut/impl/solve/objective.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace taut::solve
{

/// Objective of one function of n variables on the host:
///
///     host_objective f(2, [](std::span<const double> x, std::span<double> g) { g[0] = ...; return value; });
///
/// The function fills all of g and returns the value; +inf or NaN say "outside the domain". Points are
/// std::vector<double>; value and value_gradient throw parameter_error for those of another size.
template <class ValueGradient>
class host_objective
{
public:
    using point = std::vector<double>;
    using vector = std::vector<double>;

    host_objective(std::size_t variables, ValueGradient f) : space_(variables), scratch_(variables), f_(std::move(f)) {}

    const host_space& space() const noexcept { return space_; }
    point make_point() const { return space_.make(); }
    void copy(const point& x, point& y) const { y = x; }
    double value(const point& x) { return value_gradient(x, scratch_); }
    double value_gradient(const point& x, vector& g)
    {
        if (x.size() != space_.components())
            throw parameter_error("x", std::to_string(x.size()) + " numbers for a function of " +
                                           std::to_string(space_.components()));
        return f_(std::span<const double>(x), std::span<double>(g));
    }

    void step(const point& x, double a, const vector& d, point& out) const
    {
        for (std::size_t i = 0; i < x.size(); ++i) out[i] = x[i] + a * d[i];
    }

private:
    host_space space_;
    vector scratch_;
    ValueGradient f_;
};

} // namespace taut::solve
