// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include <taut/errors.hpp>

namespace taut::impl
{

/// Radial functions phi(r) of interpolation, r >= 0. The first three have global support and a polynomial; those of
/// Wendland (1995) have compact support.
enum class rbf_basis
{
    linear,      ///< -r: biharmonic in space; with constants
    cubic,       ///< r^3: triharmonic in space; with linear polynomials
    thin_plate,  ///< r^2 log r; with linear polynomials
    wendland_c2, ///< (1 - s)^4 (4 s + 1), s = r / radius
    wendland_c4  ///< (1 - s)^6 (35 s^2 + 18 s + 3) / 3
};

constexpr bool is_compact(rbf_basis basis)
{
    return basis == rbf_basis::wendland_c2 || basis == rbf_basis::wendland_c4;
}

/// Degree of the polynomial that goes with it, -1 for none: the smallest with which the interpolant is unique.
constexpr int polynomial_degree(rbf_basis basis)
{
    return is_compact(basis) ? -1 : basis == rbf_basis::linear ? 0 : 1;
}

/// phi(r). radius: of compact ones.
inline double rbf_value(rbf_basis basis, double r, double radius)
{
    const double s = r / radius, t = std::max(0.0, 1 - s), t2 = t * t;
    switch (basis)
    {
    case rbf_basis::linear:
        return -r;
    case rbf_basis::cubic:
        return r * r * r;
    case rbf_basis::thin_plate:
        return r > 0 ? r * r * std::log(r) : 0;
    case rbf_basis::wendland_c2:
        return t2 * t2 * (4 * s + 1);
    case rbf_basis::wendland_c4:
        return t2 * t2 * t2 * ((35 * s + 18) * s + 3) / 3;
    }
    throw parameter_error("basis", "must be linear, cubic, thin_plate, wendland_c2 or wendland_c4");
}

} // namespace taut::impl
