// SPDX-License-Identifier: MIT
#pragma once

#include <taut/solve/vector_space.hpp>

#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace taut::solve
{

/// The vector space of an objective, without the reference but with a const of its own.
template <class O>
using space_of = std::remove_reference_t<decltype(std::declval<O&>().space())>;

template <class O>
using vector_of = typename space_of<O>::vector;

/// A function f to minimise. Points and vectors may be of different types: positions in double, gradients and
/// directions in float.
///
/// | call                        | meaning                                                                        |
/// |-----------------------------|--------------------------------------------------------------------------------|
/// | `space()`                   | the space of gradients and directions                                          |
/// | `make_point()`, `copy(x,y)` | a point of the right shape, y = x                                              |
/// | `value(x)`                  | f(x); +inf or NaN outside the domain                                           |
/// | `value_gradient(x, g)`      | f(x), and g = its gradient                                                     |
/// | `step(x, a, d, out)`        | out = x + a d                                                                  |
template <class O>
concept objective = vector_space<space_of<O>> &&
    requires(O& f, const typename O::point& x, typename O::point& out, double a, const vector_of<O>& d, vector_of<O>& g)
{
    {
        f.make_point()
        } -> std::same_as<typename O::point>;
    f.copy(x, out);
    {
        f.value(x)
        } -> std::convertible_to<double>;
    {
        f.value_gradient(x, g)
        } -> std::convertible_to<double>;
    f.step(x, a, d, out);
};

/// Optional: `max_step(x, d)`, the first a > 0 at which x + a d meets a barrier; inf where it never does. No trial step
/// goes beyond a fraction of it.
template <class O>
concept has_max_step = objective<O> && requires(O& f, const typename O::point& x, const vector_of<O>& d)
{
    {
        f.max_step(x, d)
        } -> std::convertible_to<double>;
};

/// Optional: `values(x, d, a, out)`, out[i] = f(x + a[i] d) for several steps in one pass over the data.
template <class O>
concept has_values = objective<O> &&
    requires(O& f, const typename O::point& x, const vector_of<O>& d, std::span<const double> a, std::span<double> out)
{
    f.values(x, d, a, out);
};

/// Optional: `gradient_scale(x)`, the norm of a gradient that is typical for the problem. Relative gradients are
/// measured in it; without it, in the norm at the start.
template <class O>
concept has_gradient_scale = objective<O> && requires(O& f, const typename O::point& x)
{
    {
        f.gradient_scale(x)
        } -> std::convertible_to<double>;
};

/// Optional: `precondition(v, out)`, out = H0 v with H0 symmetric positive definite, an approximation of the inverse
/// Hessian up to a factor. It may change between iterations but not within one.
template <class O>
concept has_precondition = objective<O> && requires(O& f, const vector_of<O>& v, vector_of<O>& out)
{
    f.precondition(v, out);
};

/// Optional: `gradient(x, g)`, g = the gradient, without the value and without a wait.
template <class O>
concept has_gradient = objective<O> && requires(O& f, const typename O::point& x, vector_of<O>& g)
{
    f.gradient(x, g);
};

/// Optional: `capped_values(x, d, fraction, a, out)`, out[i] = f(x + u a[i] d) with u = min(1, fraction * max_step),
/// which is returned: the barrier and several trial steps in one wait.
template <class O>
concept has_capped_values = objective<O> && requires(O& f, const typename O::point& x, const vector_of<O>& d, double u,
                                                     std::span<const double> a, std::span<double> out)
{
    {
        f.capped_values(x, d, u, a, out)
        } -> std::convertible_to<double>;
};

/// Optional: `capped_values(x, d, fraction, a, out, full, g)`, the same, and in the same wait full = x + d, g = its
/// gradient and the norm of that squared, meant for steps that are expected to be taken in full.
template <class O>
concept has_full_step = has_capped_values<O> &&
    requires(O& f, const typename O::point& x, const vector_of<O>& d, double u, std::span<const double> a,
             std::span<double> out, typename O::point& full, vector_of<O>& g)
{
    {
        f.capped_values(x, d, u, a, out, full, g)
        } -> std::same_as<std::pair<double, double>>;
};

/// Optional: `value_gradient(x, g, square)`, also the norm of the gradient squared, in the same wait.
template <class O>
concept has_gradient_norm = objective<O> && requires(O& f, const typename O::point& x, vector_of<O>& g, double& square)
{
    {
        f.value_gradient(x, g, square)
        } -> std::convertible_to<double>;
};

/// What Newton's method needs: `linearize(x, exact)` fixes the point of all that follows; `hessian_product(v, out)`,
/// out = A v, where A is the Hessian if `exact` and else a positive semi-definite stand-in; `precondition(v, out)`,
/// out = M v with M an approximate inverse of the stand-in in either case.
template <class O>
concept has_hessian = has_precondition<O> &&
    requires(O& f, const typename O::point& x, bool exact, const vector_of<O>& v, vector_of<O>& out)
{
    f.linearize(x, exact);
    f.hessian_product(v, out);
};

/// Optional: `relax(x)` lowers f by other means than steps along one direction; whether it moved x.
template <class O>
concept has_relax = objective<O> && requires(O& f, typename O::point& x)
{
    {
        f.relax(x)
        } -> std::convertible_to<bool>;
};

/// Optional: `capping(x, d)`, numbers of the parts of the problem that meet the barrier first along d.
template <class O>
concept has_capping = has_max_step<O> && requires(O& f, const typename O::point& x, const vector_of<O>& d)
{
    {
        f.capping(x, d)
        } -> std::convertible_to<std::vector<int>>;
};

/// Optional: `rounding()`, the relative rounding error of a value where it is above that of double.
template <class O>
concept has_rounding = objective<O> && requires(O& f)
{
    {
        f.rounding()
        } -> std::convertible_to<double>;
};

/// Optional: `waits()`, how often the host has waited for a device so far.
template <class O>
concept has_waits = objective<O> && requires(const O& f)
{
    {
        f.waits()
        } -> std::convertible_to<std::uint64_t>;
};

} // namespace taut::solve
