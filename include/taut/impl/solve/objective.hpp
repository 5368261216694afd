// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/solve/vector_space.hpp>

#include <concepts>
#include <type_traits>
#include <utility>

namespace taut::solve::impl
{

/// Vector space type of an objective, without the reference but with a const of its own.
template <class O>
using space_of = std::remove_reference_t<decltype(std::declval<O&>().space())>;

/// Vector type of an objective, for gradients and directions.
template <class O>
using vector_of = typename space_of<O>::vector;

} // namespace taut::solve::impl

namespace taut::solve
{

/// Objective f to be minimised. Points and vectors may be of different types: positions in double, gradients and
/// directions in float.
///
/// | call                        | meaning                                                                        |
/// |-----------------------------|--------------------------------------------------------------------------------|
/// | `space()`                   | the space of gradients and directions                                          |
/// | `make_point()`, `copy(x,y)` | a point of the right shape, y = x                                              |
/// | `value(x)`                  | f(x); +inf or NaN outside the domain                                           |
/// | `value_gradient(x, g)`      | f(x), and g = its gradient                                                     |
/// | `step(x, a, d, out)`        | out = x + a d                                                                  |
///
/// Optional, each by itself; full_objective says what methods do without:
///
/// | call                              | meaning                                                                  |
/// |-----------------------------------|--------------------------------------------------------------------------|
/// | `max_step(x, d)`                  | the first a > 0 at which x + a d meets a barrier; inf where it never     |
/// |                                   | does. No trial step goes beyond a fraction of it                         |
/// | `capping(x, d)`                   | numbers of the parts of the problem that meet the barrier first along d  |
/// | `values(x, d, a, out)`            | out[i] = f(x + a[i] d), several steps in one pass over the data          |
/// | `capped_values(x, d, u, a, out,   | out[i] = f(x + s a[i] d) with s = min(most, u max_step), which is        |
/// |  most)`                           | returned: the barrier and several trial steps in one wait                |
/// | `capped_values(..., out, full, g)`| with most = 1; in the same wait full = x + d and g = its gradient; the   |
/// |                                   | pair of s and the norm of g squared. For steps that are expected to be   |
/// |                                   | taken in full                                                            |
/// | `value_gradient(x, g, square)`    | also the norm of the gradient squared, in the same wait                  |
/// | `gradient(x, g)`                  | g = the gradient, without the value and without a wait                   |
/// | `gradient_scale(x)`               | the norm of a gradient that is typical for the problem, in which         |
/// |                                   | relative gradients are measured; without it, the norm at the start       |
/// | `value_scale()`                   | a rise of f that is typical for the problem, below which values do not   |
/// |                                   | say what is much or little; without it, 0                                |
/// | `relax(x)`                        | lowers f by other means than steps along one direction; whether it moved |
/// | `eliminate(x, unexpected,         | the same, where it is farthest from quadratic: there the vectors of      |
/// |  proceed)`                        | `unexpected`, a gradient less what a model expected, are longest; asks   |
/// |                                   | proceed() whether to go on                                               |
/// | `rounding()`                      | the rounding error of a value by the larger of the value and its scale,  |
/// |                                   | where it is above that of double                                         |
/// | `waits()`                         | how often the host has waited for a device so far                        |
template <class O>
concept objective = vector_space<impl::space_of<O>> &&
    requires(O& f, const typename O::point& x, typename O::point& out, double a, const impl::vector_of<O>& d,
             impl::vector_of<O>& g)
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

} // namespace taut::solve

namespace taut::solve::impl
{

/// Optional preconditioner: `precondition(v, out)`, out = H0 v with H0 symmetric positive definite, an approximation of
/// the inverse Hessian up to a factor. It may change between iterations but not within one.
template <class O>
concept has_precondition = objective<O> && requires(O& f, const vector_of<O>& v, vector_of<O>& out)
{
    f.precondition(v, out);
};

/// Requirements of Newton's method: `linearize(x, exact)` fixes the point of all that follows; `hessian_product(v,
/// out)`, out = A v, where A is the Hessian if `exact` and else the projected (positive semi-definite) Hessian;
/// `precondition(v, out)`, out = M v with M an approximate inverse of the projected one in either case.
template <class O>
concept has_hessian = has_precondition<O> &&
    requires(O& f, const typename O::point& x, bool exact, const vector_of<O>& v, vector_of<O>& out)
{
    f.linearize(x, exact);
    f.hessian_product(v, out);
};

/// A value of f, and the change that a quadratic model of it expects along some step.
struct model_change
{
    double value, change;
};

/// Requirements for bringing coordinates of a point to prescribed values: `linearize_towards(x, share, d, g)` does what
/// `linearize(x, false)` does, and puts the fraction `share` of the remaining displacement of the prescribed
/// coordinates into d, which is 0 elsewhere, and the gradient of the model at x + d into g, which is 0 at the
/// prescribed ones; it returns f(x) and the change of the model along d. `put(x)` gives prescribed coordinates their
/// values to the last bit.
template <class O>
concept has_prescribed = has_hessian<O> &&
    requires(O& f, typename O::point& x, double share, vector_of<O>& d, vector_of<O>& g)
{
    {
        f.linearize_towards(x, share, d, g)
        } -> std::same_as<impl::model_change>;
    f.put(x);
};

} // namespace taut::solve::impl
