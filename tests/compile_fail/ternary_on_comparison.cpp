// SPDX-License-Identifier: MIT
#include <taut/symbolic.hpp>

taut::sym<float> clamp(taut::sym<float> x)
{
#ifdef TAUT_MUST_NOT_COMPILE
    return x < 0 ? -x : x;
#else
    return select(x < 0, -x, x);
#endif
}
