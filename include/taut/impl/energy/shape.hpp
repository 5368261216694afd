// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <taut/impl/energy/element.hpp>

namespace taut::energy
{

/// Conformal distortion |S|^2 / (D det(S)^(2/D)): 1 at similarities, blind to scale (eq. 4). Half of MIPS (eq. 16).
/// Eq. 11 drops the 1/2 that eq. 4 has for D = 2; here D = 2 keeps it.
struct shape
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        using std::pow;
        if constexpr (D == 2)
            return norm2(e.S) / (T(2) * e.det);
        else
            return norm2(e.S) / (T(D) * pow(e.det, T(2.0 / D)));
    }
};

} // namespace taut::energy
