// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "picture/format.hpp"

namespace taut::tools
{

/// Text as a terminal may get it: names and words of strangers' files can hold sequences that terminals obey. Control
/// characters but line ends and tabs, and broken UTF-8, become '?'.
inline std::string printable(std::string_view text)
{
    std::string out;
    while (!text.empty())
    {
        const std::size_t n = io::impl::utf8_length(text);
        const std::string_view c = text.substr(0, n > 0 ? n : 1);
        const auto byte = [c](std::size_t k) { return static_cast<unsigned char>(c[k]); };
        const bool control = n == 1   ? (byte(0) < 32 && c != "\n" && c != "\t") || byte(0) == 127
                             : n == 2 ? byte(0) == 0xC2 && byte(1) < 0xA0
                                      : false;
        if (n == 0 || control)
            out += '?';
        else
            out += c;
        text.remove_prefix(c.size());
    }
    return out;
}

} // namespace taut::tools
