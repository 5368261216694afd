// SPDX-License-Identifier: MIT
#pragma once

namespace taut
{

/// Arithmetic of the optimisation. Certificates are exact in any case.
enum class precision
{
    automatic, ///< mixed for methods with multigrid, and fp64 from there on if that did not converge; fp64 for others
    fp64,      ///< positions, elements and vectors in double
    mixed,     ///< positions in double, differences cast to float, elements and vectors in float, sums in double
    fp32       ///< everything in float, sums in double where the device has it: reaches relative gradients near 1e-5
};

} // namespace taut
