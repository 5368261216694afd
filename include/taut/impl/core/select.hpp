// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>

namespace taut
{

/// Chooses one of two plain numbers, condition ? a : b, so that a template over double and a traced scalar can write
/// `select(cond, a, b)` for both; the traced overload is found by its arguments.
template <std::floating_point T>
constexpr T select(bool condition, T a, T b)
{
    return condition ? a : b;
}

} // namespace taut
