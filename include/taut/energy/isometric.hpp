// SPDX-License-Identifier: MIT
#pragma once

#include <taut/energy/area.hpp>
#include <taut/energy/shape.hpp>

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
};

} // namespace taut::energy
