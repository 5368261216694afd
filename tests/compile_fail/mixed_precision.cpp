// SPDX-License-Identifier: MIT
// Precision changes only where the source says so.
#include <taut/symbolic.hpp>

taut::sym<double> sum(taut::sym<float> x, taut::sym<double> y)
{
#ifdef TAUT_MUST_NOT_COMPILE
    return x + y;
#else
    return taut::cast<double>(x) + y;
#endif
}
