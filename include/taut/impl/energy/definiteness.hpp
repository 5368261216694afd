// SPDX-License-Identifier: MIT
#pragma once

#include <taut/impl/energy/eigenvalue_filter.hpp>

namespace taut
{

/// Treatment of the negative eigenvalues of an element's Hessian, in the space of S, before the change to corners,
/// which keeps their sign.
enum class definiteness
{
    indefinite, ///< kept: the Hessian itself, for the last iterations
    projected,  ///< 0: negative_eigenvalues::clamped
    absolute    ///< without it: negative_eigenvalues::absolute
};

} // namespace taut

namespace taut::impl
{

/// Treatment of the projected (PSD) Hessian.
inline definiteness definite(negative_eigenvalues treated)
{
    return treated == negative_eigenvalues::absolute ? definiteness::absolute : definiteness::projected;
}

} // namespace taut::impl
