// SPDX-License-Identifier: MIT
#pragma once

#include <taut/solve/host_space.hpp>
#include <taut/solve/objective.hpp>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace taut::solve
{

/// An objective from one function of n variables on the host:
///
///     host_objective f(2, [](std::span<const double> x, std::span<double> g) { g[0] = ...; return value; });
///
/// The function fills all of g and returns the value; +inf or NaN say "outside the domain". Points are
/// std::vector<double>.
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
    double value(const point& x) { return f_(std::span<const double>(x), std::span<double>(scratch_)); }
    double value_gradient(const point& x, vector& g) { return f_(std::span<const double>(x), std::span<double>(g)); }

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
