// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/core/untangle/element_newton.hpp>

namespace taut::impl
{

triangle_newton::triangle_newton(const regularized_problem<triangle>& problem)
    : regularized_newton(problem), newton_(cells_, shapes_, problem.held)
{
}

double triangle_newton::value(const map& x)
{
    return newton_.value(x, energy(), springs);
}

} // namespace taut::impl
