// SPDX-License-Identifier: MIT
// The most natural mistake in a traced function: the comparison has no value yet.
#include <taut/recording.hpp>

int main()
{
    taut::recording r;
    const auto x = r.inout<double>("x");
    const auto i = r.global_id();
#ifdef TAUT_MUST_NOT_COMPILE
    if (x[i] < 0.0) x[i] = 0.0;
#else
    x[i] = select(x[i] < 0.0, 0.0, x[i]);
#endif
}
