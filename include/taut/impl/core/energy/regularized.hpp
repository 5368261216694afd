// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include <taut/energies.hpp>
#include <taut/impl/core/energy/invariants.hpp>
#include <taut/types.hpp>

namespace taut::energy::impl
{

/// Regularised energy of Garanzha et al. 2021 ("Foldover-free maps in 50 lines of code") in dimension D,
///
///     |S|^2 / chi^(2/D) + area_weight (det S^2 + 1) / chi,   chi = (det S + sqrt(eps^2 + det S^2)) / 2,
///
/// defined for inverted elements too as long as eps > 0; with eps = 0 it is a barrier, +infinity where det S <= 0.
template <int D>
struct regularized
{
    double eps = 1;
    double area_weight = 1;

    double chi(double det) const { return chi(det, eps, std::hypot(eps, det)); }

    double operator()(const mat<D>& S) const
    {
        const double det = glm::determinant(S);
        if (eps == 0 && !(det > 0)) return std::numeric_limits<double>::infinity();
        return value(norm2(S), det, chi(det), area_weight);
    }

    /// chi and the energy as formulas, for double and traced numbers; r = sqrt(eps^2 + det^2).
    template <class T>
    static T chi(const T& det, const T& eps, const T& r)
    {
        return select(det > 0.0, 0.5 * (det + r), 0.5 * eps * (eps / (r - det))); // the sum would cancel
    }
    template <class T>
    static T value(const T& I, const T& det, const T& chi, const T& area_weight)
    {
        return I * of_shape(chi) + area_weight * (det * det + 1.0) / chi;
    }

    /// The value and its derivatives by I = |S|^2 and d = det S.
    struct slopes
    {
        double value, by_I, by_d;
    };
    slopes first_derivatives(double I, double d) const
    {
        const double r = std::hypot(eps, d), c = chi(d, eps, r), shape = of_shape(c); // d chi / d det = chi / r
        return {value(I, d, c, area_weight), shape,
                -2.0 / D * I * shape / r + area_weight * (2 * d - (d * d + 1) / r) / c};
    }
    taut::impl::invariant_derivatives<double> derivatives(double I, double d) const requires(D == 2)
    {
        // h = 1 / chi and its derivatives by d; G is what stands over chi.
        const double r = std::hypot(eps, d), h = 1 / chi(d, eps, r), h1 = -h / r, h2 = 2 / (r * r * r);
        const double G = I + area_weight * (d * d + 1);
        return {I, d, h, 2 * area_weight * d * h + G * h1, 0, h1, 2 * area_weight * (h + 2 * d * h1) + G * h2};
    }

private:
    template <class T>
    static T of_shape(const T& chi)
    {
        using std::cbrt;
        if constexpr (D == 2)
            return 1.0 / chi;
        else
            return 1.0 / cbrt(chi * chi);
    }
};

/// Regularised energy with eps and area_weight as parameters 0 and 1, so that changing them needs no new kernel. For
/// eps = 0 it is +infinity or not a number outside the barrier's domain.
struct regularized_element
{
    static constexpr bool barrier = false;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        using std::sqrt;
        const T eps = e.parameter(0), r = sqrt(eps * eps + e.det * e.det);
        return regularized<D>::value(norm2(e.S), e.det, regularized<D>::chi(e.det, eps, r), e.parameter(1));
    }
};

} // namespace taut::energy::impl
