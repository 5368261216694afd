// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace taut::impl
{

/// Name of a value of an enumeration that counts from 0 and ends with Last: that of its place in a list.
template <auto Last, std::size_t N>
constexpr const char* name_in(const char* const (&names)[N], decltype(Last) value)
{
    static_assert(N == static_cast<std::size_t>(Last) + 1, "a name for each value, in their order");
    const auto at = static_cast<std::size_t>(value);
    return at < N ? names[at] : "unknown";
}

} // namespace taut::impl
