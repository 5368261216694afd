// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace taut::impl
{

/// n rounded up to a multiple of unit.
constexpr std::size_t padded(std::size_t n, std::size_t unit = 1024)
{
    return (n + unit - 1) / unit * unit;
}

} // namespace taut::impl
