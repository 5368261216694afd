// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include <taut/core/linalg.hpp>
#include <taut/energy/invariants.hpp>

namespace taut::energy
{

/// The regularised energy of Garanzha et al. 2021 ("Foldover-free maps in 50 lines of code") in dimension D,
///
///     |S|^2 / chi^(2/D) + area_weight (det S^2 + 1) / chi,   chi = (det S + sqrt(eps^2 + det S^2)) / 2,
///
/// defined for inverted elements too as long as eps > 0; with eps = 0 it is a barrier, +infinity where det S <= 0.
template <int D>
struct regularized
{
    double eps = 1;
    double area_weight = 1;

    double chi(double det) const { return chi(det, std::hypot(eps, det)); }

    double operator()(const mat<D>& S) const
    {
        const double det = glm::determinant(S);
        if (eps == 0 && !(det > 0)) return std::numeric_limits<double>::infinity();
        return value(norm2(S), det, chi(det));
    }

    /// The value and its derivatives by I = |S|^2 and d = det S.
    struct slopes
    {
        double value, by_I, by_d;
    };
    slopes first_derivatives(double I, double d) const
    {
        const double r = std::hypot(eps, d), c = chi(d, r), shape = of_shape(c); // d chi / d det = chi / r
        return {value(I, d, c), shape, -2.0 / D * I * shape / r + area_weight * (2 * d - (d * d + 1) / r) / c};
    }
    invariant_derivatives<double> derivatives(double I, double d) const requires(D == 2)
    {
        // h = 1 / chi and its derivatives by d; G is what stands over chi.
        const double r = std::hypot(eps, d), h = 1 / chi(d, r), h1 = -h / r, h2 = 2 / (r * r * r);
        const double G = I + area_weight * (d * d + 1);
        return {I, d, h, 2 * area_weight * d * h + G * h1, 0, h1, 2 * area_weight * (h + 2 * d * h1) + G * h2};
    }

private:
    double chi(double det, double r) const
    {
        return det > 0 ? 0.5 * (det + r) : 0.5 * eps * (eps / (r - det)); // the sum would cancel
    }
    static double of_shape(double chi) { return D == 2 ? 1 / chi : 1 / std::cbrt(chi * chi); }
    double value(double I, double d, double chi) const
    {
        return D == 2 ? (I + area_weight * (d * d + 1)) / chi : I * of_shape(chi) + area_weight * (d * d + 1) / chi;
    }
};

} // namespace taut::energy
