// SPDX-License-Identifier: MIT
#pragma once

#include <taut/any_energy.hpp>
#include <taut/impl/core/energy/eigenvalue_filter.hpp>

namespace taut::impl
{

/// Treatment of the projected (PSD) Hessian.
inline definiteness definite(negative_eigenvalues treated)
{
    return treated == negative_eigenvalues::absolute ? definiteness::absolute : definiteness::projected;
}

} // namespace taut::impl
