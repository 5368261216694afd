// SPDX-License-Identifier: MIT
#pragma once

#include <taut/types.hpp>

namespace taut::impl
{

/// First and second derivatives of an energy E = psi(I, d) by the invariants I = |S|^2 and d = det S.
template <class Real>
struct invariant_derivatives
{
    Real I, d;
    Real by_I, by_d;
    Real by_II, by_Id, by_dd;
};

/// d det S / dS.
template <class Real>
glm::mat<2, 2, Real> cofactors(const glm::mat<2, 2, Real>& S)
{
    return {S[1][1], -S[1][0], -S[0][1], S[0][0]};
}
template <class Real>
glm::mat<3, 3, Real> cofactors(const glm::mat<3, 3, Real>& S)
{
    return {glm::cross(S[1], S[2]), glm::cross(S[2], S[0]), glm::cross(S[0], S[1])};
}

/// dE/dS from the derivatives by the invariants.
template <int D, class Real>
glm::mat<D, D, Real> gradient_by_shape(const glm::mat<D, D, Real>& S, const Real& by_I, const Real& by_d)
{
    return Real(2.0) * by_I * S + by_d * cofactors(S);
}

} // namespace taut::impl
