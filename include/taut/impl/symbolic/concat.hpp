// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace taut::impl
{

/// The parts one after the other. Not operator+, whose insertions in front g++ 12 warns about without need.
template <class... Parts>
std::string concat(const Parts&... parts)
{
    std::string text;
    (text.append(std::string_view(parts)), ...);
    return text;
}

/// A letter and a number, as t12 and i0 in the text of a kernel.
inline std::string numbered(std::string_view letter, std::uint64_t number)
{
    return concat(letter, std::to_string(number));
}

} // namespace taut::impl
