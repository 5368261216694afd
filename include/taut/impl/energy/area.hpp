// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/energy/element.hpp>

namespace taut::energy
{

/// Area (volume) distortion det S + 1/det S: 2 where the measure is kept, blind to shape (eq. 18).
struct area
{
    static constexpr bool barrier = true;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        return e.det + T(1) / e.det;
    }
};

} // namespace taut::energy
