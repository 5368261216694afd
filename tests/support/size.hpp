// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <string_view>

namespace taut::test
{

/// The usual size of a test, the small one where TAUT_TEST_SIZE=small (under Oclgrind, which runs item after item), or
/// the large one where it is large.
inline int sized(int usual, int small, int large)
{
    const char* wish = std::getenv("TAUT_TEST_SIZE");
    if (!wish) return usual;
    const std::string_view size = wish;
    return size == "small" ? small : size == "large" ? large : usual;
}
inline int sized(int usual, int small)
{
    return sized(usual, small, usual);
}

} // namespace taut::test
