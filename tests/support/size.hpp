// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <string_view>

namespace taut::test
{

/// The usual size of a test, or the small one where TAUT_TEST_SIZE=small (under Oclgrind, which runs item after item).
inline int sized(int usual, int small)
{
    const char* wish = std::getenv("TAUT_TEST_SIZE");
    return wish && std::string_view(wish) == "small" ? small : usual;
}

} // namespace taut::test
