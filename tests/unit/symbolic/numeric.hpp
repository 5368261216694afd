// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <taut/symbolic.hpp>

/// Relative agreement, absolute below 1.
template <class T>
bool near(T a, T b, double tolerance)
{
    return std::abs(double(a) - double(b)) <= tolerance * (1 + std::max(std::abs(double(a)), std::abs(double(b))));
}

/// The central difference of a host function with its error extrapolated away once: O(h^4).
template <class F>
double difference(F f, double x, double h = 1e-3)
{
    const auto central = [&](double step) { return (f(x + step) - f(x - step)) / (2 * step); };
    return (4 * central(h / 2) - central(h)) / 3;
}
