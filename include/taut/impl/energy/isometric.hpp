// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/energy/area.hpp>
#include <taut/impl/energy/invariants.hpp>
#include <taut/impl/energy/shape.hpp>

namespace taut::energy
{

/// Isometric distortion, minimal exactly at rotations.
/// D = 2: |S|^2 (1 + 1/det^2), the symmetric Dirichlet energy, minimum 4. It is eq. 19 with the squares that the print
/// drops, and twice shape x area (eqs. 4, 18).
/// D = 3: shape x area, minimum 2. (Eq. 19 taken over literally would be minimal at a dilation of 2^(1/6).)
struct isometric
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        if constexpr (D == 2)
            return norm2(e.S) * (T(1) + T(1) / (e.det * e.det));
        else
            return shape{}(e)*area{}(e);
    }

    /// In the plane, by the invariants I = |S|^2 and d = det S: where the energy itself is not traced.
    template <class T>
    static taut::impl::invariant_derivatives<T> derivatives(const T& I, const T& d)
    {
        const T r = T(1) / d, r2 = r * r;
        return {I, d, T(1) + r2, T(-2) * I * r2 * r, T(0), T(-2) * r2 * r, T(6) * I * r2 * r2};
    }
};

} // namespace taut::energy
