// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <taut/energy/element.hpp>

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
        using std::log;
        const double mu = 0.5 / (1 + poisson), lambda = poisson / ((1 + poisson) * (1 - 2 * poisson));
        const T log_j = log(e.det);
        return T(0.5 * mu) * (norm2(e.S) - T(double(D)) - T(2) * log_j) + T(0.5 * lambda) * log_j * log_j;
    }
};

} // namespace taut::energy
