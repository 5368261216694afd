// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include <taut/any_energy.hpp>

namespace taut::impl
{

/// Typical increase of the energy above its value at rest: the largest at a stretch by 2 or by 1/2 along one axis, of
/// the densities that are finite; 0 if none rises. It is the scale of the energy, which may be 0 at rest: 2.25 for the
/// isometric energy in the plane, which is 4 at rest.
template <int D>
double characteristic_value(const any_energy& energy)
{
    const auto at = [&](const mat<D>& S) { return energy(element<double, D>{S, glm::determinant(S), 1.0}); };
    const double rest = at(mat<D>(1.0));
    double most = 0;
    for (int axis = 0; axis < D; ++axis)
        for (const double stretch : {2.0, 0.5})
        {
            mat<D> S(1.0);
            S[axis][axis] = stretch;
            if (const double rise = at(S) - rest; std::isfinite(rise)) most = std::max(most, rise);
        }
    return most;
}

} // namespace taut::impl
