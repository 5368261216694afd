// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/energy/shape.hpp>

namespace taut::energy
{

/// Shape energy raised to a power: the larger it is, the more the worst elements count. 1 at similarities.
struct shape_power
{
    static constexpr bool barrier = true;

    int power = 2; ///< at least 1

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        const T once = shape{}(e);
        T all = once;
        for (int k = 1; k < power; ++k) all = all * once;
        return all;
    }
};

} // namespace taut::energy
