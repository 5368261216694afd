// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>

#include <taut/solve_params.hpp>

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
