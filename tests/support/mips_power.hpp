// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <taut/energies.hpp>

namespace taut::test
{

/// A user's energy, MIPS to a power: nothing is known of its eigenvalues in advance.
struct mips_power
{
    static constexpr bool barrier = true;
    double p = 2;

    template <class T, int D>
    T operator()(const element<T, D>& e) const
    {
        using std::pow;
        return pow(norm2(e.S) / (D * pow(e.det, T(2.0 / D))), T(p));
    }
};

} // namespace taut::test
