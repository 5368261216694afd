// SPDX-License-Identifier: MIT
#include <taut/impl/enter.inl>
#ifndef TAUT_MINIMIZE_HPP
#define TAUT_MINIMIZE_HPP

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <taut/errors.hpp>
#include <taut/impl/core/solve/conjugate_gradient.hpp>
#include <taut/impl/core/solve/gradient_descent.hpp>
#include <taut/impl/core/solve/host_space.hpp>
#include <taut/impl/core/solve/lbfgs.hpp>
#include <taut/impl/core/solve/newton.hpp>
#include <taut/solve_params.hpp>

/// Solvers for functions of your own: Newton, L-BFGS, gradient descent and conjugate gradients over any vector
/// space.
namespace taut::solve
{

/// Vector space of std::vector<double>.
using host_space = impl::basic_host_space<double>;

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

/// Minimises f from x. x becomes the best iterate, whatever the reason to stop, which the report names; the values
/// in its history fall monotonically. The current evaluation is finished, whatever the limits. Throws parameter_error,
/// and what f and the observer throw: x is then the last iterate.
template <objective Objective>
report minimize(Objective& f, typename Objective::point& x, const params& p = {}, const run_limits& limits = {})
{
    p.validate();
    limits.validate();
    switch (p.method)
    {
    case method::automatic:
    case method::newton:
        if constexpr (impl::has_hessian<Objective>)
        {
            p.require_newton_search();
            return newton(f, x, p.tuning.newton, p.common(), limits);
        }
        if (p.method == method::newton) throw parameter_error("method", "newton needs an objective with a Hessian");
        break;
    case method::conjugate_gradient:
        return impl::conjugate_gradient(f, x, p.tuning.conjugate_gradient, p.common(), limits);
    case method::gradient_descent:
        return impl::gradient_descent(f, x, p.common(), limits);
    case method::lbfgs:
        break;
    }
    return impl::lbfgs(f, x, p.tuning.lbfgs, p.common(), limits);
}

} // namespace taut::solve

#endif
#include <taut/impl/leave.inl>
