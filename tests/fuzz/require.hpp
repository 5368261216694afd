// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <cstdlib>

namespace taut::fuzz
{

/// Ends the fuzzer where a promise is broken.
inline void require(bool kept, const char* promise)
{
    if (kept) return;
    std::fprintf(stderr, "broken: %s\n", promise);
    std::abort();
}

} // namespace taut::fuzz
