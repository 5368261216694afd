// SPDX-License-Identifier: MIT
// An array that was declared as written only cannot be read.
#include <taut/recording.hpp>

int main()
{
    taut::recording r;
#ifdef TAUT_MUST_NOT_COMPILE
    const auto y = r.out<double>("y");
#else
    const auto y = r.inout<double>("y");
#endif
    const auto i = r.global_id();
    y[i + 1] = 2 * y[i];
}
