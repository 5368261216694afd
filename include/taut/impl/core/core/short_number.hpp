// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace taut::impl
{

/// A number for messages, with some significant digits.
inline std::string short_number(double x, int digits = 4)
{
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::general, digits).ptr;
    return {text.data(), end};
}

} // namespace taut::impl
