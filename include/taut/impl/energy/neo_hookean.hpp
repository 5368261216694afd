// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>

#include <taut/impl/energy/element.hpp>

namespace taut::energy
{

/// Strain energy density of a compressible neo-Hookean solid of Young's modulus 1 (Bonet and Wood, Nonlinear Continuum
/// Mechanics for Finite Element Analysis, eq. 6.27): mu / 2 (|S|^2 - D - 2 log J) + lambda / 2 (log J)^2, J = det S. 0
/// at rotations; in the plane, plane strain.
struct neo_hookean
{
    static constexpr bool barrier = true;

    double poisson = 0.3; ///< ratio, in (-1, 0.5); near 0.5 volumes are kept, and linear tetrahedra lock

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        const auto lame = of_poisson(poisson);
        return density(e, lame[0], lame[1]);
    }

    /// mu and lambda for a Poisson ratio, at Young's modulus 1.
    static std::array<double, 2> of_poisson(double ratio)
    {
        return {0.5 / (1 + ratio), ratio / ((1 + ratio) * (1 - 2 * ratio))};
    }

    /// With these mu and lambda.
    template <class T, int D, class Number>
    static T density(const element<T, D>& e, const Number& mu, const Number& lambda)
    {
        using std::log;
        const T log_j = log(e.det);
        return T(0.5 * mu) * (norm2(e.S) - T(double(D)) - T(2) * log_j) + T(0.5 * lambda) * log_j * log_j;
    }
};

/// Neo-Hookean energy with mu = e.parameter(0) and lambda = e.parameter(1), as neo_hookean::of_poisson() gives them:
/// changing them needs no new kernel.
struct neo_hookean_of_parameters
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return neo_hookean::density(e, e.parameter(0), e.parameter(1));
    }
};

} // namespace taut::energy
